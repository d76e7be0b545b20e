/// A plugin that crashes ends the process. The handler reports which plugin it was and what the user can do.
#pragma once

#include "dismantle/host/registry.h"
#include "run_notes.h"

namespace dismantle::app {

enum class AfterCrash {
  exit,      ///< prints the message (and with `json` a line of JSON) and ends with status 4
  hand_over  ///< writes to RunNotes::culprit and ends by the signal; the parent process prints the message
};

/// Installs a handler that searches the stack for code of plugins at SIGSEGV, SIGBUS, SIGFPE, SIGILL and SIGABRT.
/// `registry`: the loaded plugins; null: not known yet, plugins are recognized by their file names. `notes` must live
/// as long as the process. A later call replaces an earlier one.
void report_crashes(const Registry* registry, RunNotes& notes, AfterCrash after, bool json);

/// Advice for the user after a plugin has crashed. `isolated`: the run used --isolate.
std::string advice_after_crash(bool isolated);

}  // namespace dismantle::app
