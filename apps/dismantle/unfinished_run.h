/// Saves the results of runs that a plugin keeps from ending.
#pragma once

#include <filesystem>
#include <mutex>
#include <string>

#include "console.h"
#include "dismantle/assembly.h"
#include "dismantle/host/config.h"
#include "dismantle/run_context.h"
#include "isolation.h"
#include "plan_files.h"

namespace dismantle::app {

/// Saves the results of a run whose plugin does not stop. Called on the watchdog's thread; other threads may still run.
class GiveUp {
 public:
  GiveUp(const RunConfig& config, const RunContext& context, std::filesystem::path folder, Console& console)
      : config_(config), context_(context), folder_(std::move(folder)), console_(console) {}

  /// Sets the source of steps to save. Both objects must outlive this one.
  void has(const Assembly& assembly, const Saver& saver) {
    const std::lock_guard lock(mutex_);
    assembly_ = &assembly;
    saver_ = &saver;
  }

  /// Saves, reports the reason, and ends the process.
  [[noreturn]] void operator()();

 private:
  nlohmann::ordered_json save(const std::string& why);

  const RunConfig& config_;
  const RunContext& context_;
  const std::filesystem::path folder_;
  Console& console_;
  std::mutex mutex_;
  const Assembly* assembly_ = nullptr;
  const Saver* saver_ = nullptr;
};

/// For the parent of an isolated run that did not end by itself: writes the output files for the finished steps.
/// Returns the exit status.
int finish_for(const IsolatedEnd& end, const RunNotes& notes, const ConsoleOptions& console);

}  // namespace dismantle::app
