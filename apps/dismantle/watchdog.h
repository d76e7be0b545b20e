/// Ends the process when plugins do not stop on request.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "dismantle/run_context.h"

namespace dismantle::app {

/// A plugin that never checks its RunContext cannot be stopped from outside: its thread ends only with the process.
class Watchdog {
 public:
  /// `grace`: seconds that work has to end after the deadline of `context` or its cancellation; 0: the watchdog does
  /// nothing. `give_up` is called once, on a separate thread, and ends the process.
  Watchdog(const RunContext& context, double grace, std::function<void()> give_up);
  /// Call it when the work has ended by itself. Waits for `give_up` if that was already called.
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  void watch(std::stop_token stop);

  const Deadline deadline_;
  const CancelToken cancel_;
  const double grace_;
  const std::function<void()> give_up_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;  // last member: it stops before the members that it uses are destroyed
};

}  // namespace dismantle::app
