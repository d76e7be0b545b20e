/// Runs that a plugin does not let come to an end: what is saved of them.
#pragma once

#include <filesystem>
#include <mutex>
#include <string>

#include "dismantle/assembly.h"
#include "dismantle/console.h"
#include "dismantle/host/config.h"
#include "dismantle/isolation.h"
#include "dismantle/plan_files.h"
#include "dismantle/run_context.h"

namespace dismantle::app {

/// What a run that a plugin holds up leaves behind. Called on the watchdog's thread; the others may be anywhere.
class GiveUp {
 public:
  GiveUp(const RunConfig& config, const RunContext& context, std::filesystem::path folder, Console& console)
      : config_(config), context_(context), folder_(std::move(folder)), console_(console) {}

  /// From now on there are steps to save. Both must outlive this.
  void has(const Assembly& assembly, const Saver& saver) {
    const std::lock_guard lock(mutex_);
    assembly_ = &assembly;
    saver_ = &saver;
  }

  /// Saves, says why, and ends the process.
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

/// For the parent of an isolated run that did not end by itself: writes the files of the steps that were finished.
/// Returns the exit status.
int finish_for(const IsolatedEnd& end, const RunNotes& notes, const ConsoleOptions& console);

}  // namespace dismantle::app
