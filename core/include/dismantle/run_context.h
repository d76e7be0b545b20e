/// Context that a run passes to all of its work: time, cancellation, randomness, progress, log.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "dismantle/export.h"

namespace dismantle {

/// Point in time after which work should stop; default: never.
class DISMANTLE_API Deadline {
 public:
  /// Monotonic.
  using Clock = std::chrono::steady_clock;
  Deadline() = default;
  static Deadline after_seconds(double s);
  bool passed() const { return at_ != Clock::time_point::max() && Clock::now() >= at_; }
  Deadline earlier(const Deadline& other) const;
  double seconds_left() const;  ///< +infinity when there is none

 private:
  Clock::time_point at_ = Clock::time_point::max();
};

/// Shared flag; set once, from any thread or a signal handler.
class CancelToken {
 public:
  CancelToken() : flag_(std::make_shared<std::atomic<bool>>(false)) {}
  void cancel() const noexcept { flag_->store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept { return flag_->load(std::memory_order_relaxed); }

 private:
  std::shared_ptr<std::atomic<bool>> flag_;
};

/// SplitMix64-seeded xoshiro256**: small, fast, the same on every machine.
class DISMANTLE_API Rng {
 public:
  explicit Rng(std::uint64_t seed = 1);
  std::uint64_t next();
  double uniform();                      ///< [0, 1)
  double uniform(double lo, double hi);  ///< [lo, hi)
  std::uint64_t below(std::uint64_t n);  ///< [0, n), n > 0, unbiased
  double normal();                       ///< mean 0, variance 1
  /// Independent generator for one purpose; does not depend on earlier draws from this one.
  Rng fork(std::uint64_t stream) const;

 private:
  std::uint64_t seed_;
  std::uint64_t s_[4];
};

class Executor;

/// How important a message is.
enum class LogLevel { debug, info, warning, error };

/// Progress of a phase ("prepare", "fields", "sequence", ...). done <= total; total 0 = unknown.
struct ProgressEvent {
  std::string_view phase;
  std::size_t done = 0;
  std::size_t total = 0;
  std::string_view detail;  ///< for example the current part
};

/// Handed down by value; copies share the sinks and the cancellation flag.
struct RunContext {
  Deadline deadline;
  CancelToken cancel;
  Rng rng{1};
  unsigned threads = 1;                ///< >= 1, to divide or prefetch work for; results never depend on it
  std::shared_ptr<Executor> executor;  ///< its idle threads may help, whatever `threads` is; may be null
  bool speculative = false;            ///< the result may not be needed: long work calls pause_point() regularly
  std::function<void(const ProgressEvent&)> on_progress;   ///< may be empty; called from one thread at a time
  std::function<void(LogLevel, std::string_view)> on_log;  ///< may be empty; called from several threads

  bool should_stop() const { return cancel.cancelled() || deadline.passed(); }
  void progress(std::string_view phase, std::size_t done, std::size_t total, std::string_view detail = {}) const {
    if (on_progress) on_progress({phase, done, total, detail});
  }
  void log(LogLevel level, std::string_view text) const {
    if (on_log) on_log(level, text);
  }
};

}  // namespace dismantle
