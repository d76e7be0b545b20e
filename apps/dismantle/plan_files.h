/// Writes the output files of a run.
#pragma once

#include <chrono>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/console.h"
#include "dismantle/engine/run.h"
#include "dismantle/plan.h"

namespace dismantle::app {

/// Removes the files that an earlier run wrote to `folder`, so that no older plan is mistaken for the plan of a failed
/// run. Keeps `input`.
void remove_old_results(const std::filesystem::path& folder, const std::filesystem::path& input);

/// Returns the names of the files in `folder`.
std::vector<std::string> write_results(const RunResult& result, const Assembly& assembly,
                                       const std::filesystem::path& folder, Console& console);

/// Saves the growing plan at every step, or at most once per second (a crash then loses the steps of one second).
/// Thread-safe.
class Saver {
 public:
  enum class When { every_second, every_step };

  /// Both references must outlive this.
  Saver(std::filesystem::path file, const Assembly& assembly, const RunOptions& options, Console& console, When when);

  /// Saves the current plan.
  void save();

  /// Takes another step.
  void operator()(const Disassembly& so_far, const DisassemblyStep& newest);
  /// The plan with all finished steps.
  Plan latest() const;

 private:
  void report(const DisassemblyStep& step, std::size_t number) const;

  std::filesystem::path file_;
  const Assembly& assembly_;
  const RunOptions& options_;
  Console& console_;
  mutable std::mutex mutex_;
  Disassembly latest_;
  bool saved_once_ = false;
  std::chrono::steady_clock::time_point saved_;
  const When when_;
};

}  // namespace dismantle::app
