#include "watchdog.h"

#include <chrono>
#include <utility>

namespace dismantle::app {

Watchdog::Watchdog(const RunContext& context, double grace, std::function<void()> give_up)
    : deadline_(context.deadline), cancel_(context.cancel), grace_(grace), give_up_(std::move(give_up)) {
  if (grace_ > 0) thread_ = std::jthread([this](std::stop_token stop) { watch(std::move(stop)); });
}

Watchdog::~Watchdog() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void Watchdog::watch(std::stop_token stop) {
  // Signals cannot notify a condition variable, so the flag is polled.
  Deadline patience;
  bool told = false;
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    wake_.wait_for(lock, stop, std::chrono::milliseconds(100), [] { return false; });
    if (!told && (cancel_.cancelled() || deadline_.passed())) {
      told = true;
      patience = Deadline::after_seconds(grace_);
    }
    if (told && patience.passed() && !stop.stop_requested()) {
      give_up_();
      return;
    }
  }
}

}  // namespace dismantle::app
