/// Aborts long work that has no partial result.
#pragma once

#include <string>

#include "dismantle/errors.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// @throws Error when the context says to stop; `doing` names the aborted work.
inline void stop_if_asked(const RunContext& context, const char* doing) {
  if (!context.should_stop()) return;
  throw Error(std::string(context.cancel.cancelled() ? "interrupted" : "out of time") + " while " + doing);
}

}  // namespace dismantle
