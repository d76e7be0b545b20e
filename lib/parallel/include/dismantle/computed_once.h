/// A value computed by the first thread that asks for it and shared by all.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "dismantle/executor.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// A value for several threads. Threads that ask during the computation wait; meanwhile their slots are free for
/// threads that help to compute it.
template <class Value>
class ComputedOnce {
 public:
  /// compute() -> std::optional<Value> runs with no lock held. If it returns nothing or throws, the next thread that
  /// asks or waits tries again. The value never moves. Returns null if the compute() of this call returned nothing.
  template <class Compute>
  const Value* get(const RunContext& context, Compute&& compute) {
    std::unique_lock lock(mutex_);
    while (!value_ && computing_) wait(lock, context);
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
    const Executor::BlockingScope blocking(context.executor.get());
    ended_.wait(lock, [this] { return !computing_; });
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
