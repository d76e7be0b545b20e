/// How many threads are in a section at the same time.
#pragma once

#include <atomic>
#include <thread>

namespace dismantle {

/// How many threads are in a section now, and at most so far.
class Gauge {
 public:
  explicit Gauge(int now = 0) : now_(now), most_(now) {}
  void enter() {
    const int now = ++now_;
    for (int seen = most_; now > seen && !most_.compare_exchange_weak(seen, now);) {
    }
  }
  void leave() { --now_; }
  int now() const { return now_; }
  int most() const { return most_; }

 private:
  std::atomic<int> now_, most_;
};

inline void yield_times(int n) {
  for (int k = 0; k < n; ++k) std::this_thread::yield();
}

}  // namespace dismantle
