/// Ctrl-C and SIGTERM: once asks the run to stop and save, twice ends the process.
#pragma once

#include "dismantle/run_context.h"

namespace dismantle::app {

/// From now on the first signal cancels `token`. Call once.
void cancel_on_signals(const CancelToken& token);

}  // namespace dismantle::app
