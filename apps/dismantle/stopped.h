/// A command that was interrupted or reached its time limit.
#pragma once

#include "command.h"
#include "dismantle/errors.h"
#include "dismantle/run_context.h"

namespace dismantle::app {

class Stopped : public Error {
 public:
  Stopped(const RunContext& context, const std::string& what)
      : Error(what), status_(context.cancel.cancelled() ? kInterrupted : kPartial) {}
  int status() const { return status_; }

 private:
  int status_;
};

/// Runs `work`. Turns the plain Error that core functions throw when `context` should stop into Stopped.
template <class Work>
auto stoppable(const RunContext& context, Work work) {
  try {
    return work();
  } catch (const Error& e) {
    if (!context.should_stop() || typeid(e) != typeid(Error)) throw;
    throw Stopped(context,
                  context.cancel.cancelled() ? "interrupted" : std::string("out of time (run.timeout): ") + e.what());
  }
}

}  // namespace dismantle::app
