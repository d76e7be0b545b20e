/// Writes the output files of a run.
#pragma once

#include <chrono>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "console.h"
#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/session/session.h"

namespace dismantle::app {

/// Removes the files that an earlier run wrote to `folder`, so that no older plan is mistaken for the plan of a failed
/// run. Keeps `input`.
void remove_old_results(const std::filesystem::path& folder, const std::filesystem::path& input);

/// As write_results(), with a warning when there is no page, and resolved.yaml in the list.
std::vector<std::string> write_all(const RunResult& result, const Assembly& assembly,
                                   const std::filesystem::path& folder, Console& console);

/// Saves the growing plan at every step; or at most once per second, and so seldom that saving, which takes longer for
/// a longer plan, takes a twentieth of the time at most. A crash then loses the steps since. Thread-safe.
class Saver {
 public:
  /// The references must outlive this. @throws InputError, Error when the assembly cannot be planned with these
  /// settings.
  Saver(std::filesystem::path file, const Session& session, const LoadedAssembly& loaded, std::string part,
        Console& console);

  /// Saves the current plan, and from now on at every step.
  void save_every_step();

  /// Takes another step.
  void operator()(const Disassembly& so_far, const DisassemblyStep& newest);
  /// The plan with all finished steps.
  Plan latest() const;

 private:
  void report(const DisassemblyStep& step, std::size_t number) const;

  std::filesystem::path file_;
  const Session& session_;
  const LoadedAssembly& loaded_;
  const std::string part_;
  Console& console_;
  mutable std::mutex mutex_;
  Disassembly latest_;
  bool saved_once_ = false;
  std::chrono::steady_clock::time_point next_save_;
  bool every_step_ = false;
};

}  // namespace dismantle::app
