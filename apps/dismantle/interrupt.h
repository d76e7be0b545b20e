/// Handling of Ctrl-C and SIGTERM: the first signal asks the run to stop and save, the second ends the process.
#pragma once

#include "dismantle/run_context.h"

namespace dismantle::app {

/// Installs the handler; the first signal cancels `token`. Call once.
void cancel_on_signals(const CancelToken& token);

}  // namespace dismantle::app
