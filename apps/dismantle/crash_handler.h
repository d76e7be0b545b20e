/// A plugin that crashes takes the process with it: says which one it was, and what to do.
#pragma once

#include "dismantle/host/registry.h"
#include "dismantle/run_notes.h"

namespace dismantle::app {

enum class AfterCrash {
  exit,      ///< prints the message (and with `json` a line of JSON) and ends with status 4
  hand_over  ///< leaves it in RunNotes::culprit and dies by the signal: another process prints it
};

/// From now on, at SIGSEGV, SIGBUS, SIGFPE, SIGILL and SIGABRT, the stack is searched for code of a plugin. `registry`:
/// those that are loaded; null: not known yet, a plugin is told by the name of its file. `notes` has to live as long as
/// the process. A later call takes the place of an earlier one.
void report_crashes(const Registry* registry, RunNotes& notes, AfterCrash after, bool json);

/// What a user can do about a plugin that crashes, for `isolated` runs and others.
std::string advice_after_crash(bool isolated);

}  // namespace dismantle::app
