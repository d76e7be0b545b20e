/// What the first who asks computes, and the others share.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "dismantle/crew.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// A value for several threads. Those who come while it is computed wait, and leave their places to who helps with it.
template <class Value>
class ComputedOnce {
 public:
  /// compute() -> std::optional<Value>, with no lock held; nothing, or an exception: not this time, and the next who
  /// asks, or waits, tries again. The value stays where it is. Null: this caller's compute() gave nothing.
  template <class Compute>
  const Value* get(const RunContext& context, Compute&& compute) {
    std::unique_lock lock(mutex_);
    while (!value_ && computing_) wait(lock, context);  // who waited, too, may be quicker to try again
    if (value_) return &*value_;
    computing_ = true;
    lock.unlock();
    std::optional<Value> made;
    try {
      made = compute();
    } catch (...) {
      lock.lock();
      end();
      throw;
    }
    lock.lock();
    value_ = std::move(made);
    end();
    return value_ ? &*value_ : nullptr;
  }

 private:
  void wait(std::unique_lock<std::mutex>& lock, const RunContext& context) {
    lock.unlock();
    if (context.crew) context.crew->leave();
    lock.lock();
    ended_.wait(lock, [this] { return !computing_; });
    lock.unlock();
    if (context.crew) context.crew->enter();
    lock.lock();
  }

  void end() {
    computing_ = false;
    ended_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable ended_;
  bool computing_ = false;
  std::optional<Value> value_;
};

}  // namespace dismantle
