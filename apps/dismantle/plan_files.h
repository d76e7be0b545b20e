/// The files of a run: what is written to its folder, and when.
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

/// Removes what an earlier run wrote to `folder`, so that a run that fails leaves no older plan behind that would be
/// taken for its own. `input` is left alone.
void remove_old_results(const std::filesystem::path& folder, const std::filesystem::path& input);

/// Returns the names of the files in `folder`.
std::vector<std::string> write_results(const RunResult& result, const Assembly& assembly,
                                       const std::filesystem::path& folder, Console& console);

/// Saves the plan while it grows, at most once a second (what a crash can cost is one second's steps) or at every step.
/// Safe to call from several threads.
class Saver {
 public:
  enum class When { every_second, every_step };

  /// `plan`: the one before the first step.
  Saver(std::filesystem::path file, Plan plan, Console& console, When when);

  /// The plan as it is.
  void save();

  /// The plan after one more step.
  void operator()(const Plan& plan);
  /// All steps that are finished.
  Plan latest() const;

 private:
  void report(const Plan& plan);

  std::filesystem::path file_;
  Console& console_;
  mutable std::mutex mutex_;
  Plan latest_;
  bool saved_once_ = false;
  std::chrono::steady_clock::time_point saved_;
  const When when_;
};

}  // namespace dismantle::app
