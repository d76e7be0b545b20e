/// Values that are computed on idle threads before they are asked for.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "dismantle/executor.h"

namespace dismantle {

/// A value must depend only on its key. Then it does not matter which thread computes it or when, and get() returns the
/// same on any number of threads. `Key` needs operator<. All members may be called from several threads, but only one
/// thread at a time may ask for the same key.
template <class Key, class Value>
class SpeculativeCache {
 public:
  /// Computes a value; runs on any thread, and stops early when its context says so (such a value is not kept). The
  /// context of a speculative computation has the executor, a deadline and a cancellation flag, but no sinks for
  /// progress and log.
  using Compute = std::function<Value(const RunContext&)>;
  /// A value that may be asked for soon.
  struct Request {
    Key key;
    Compute compute;
  };
  /// Requests in the expected order of get() calls. A request is useful only if those before it are known and none of
  /// them ends the sequence; see the constructor.
  using Sequence = std::deque<Request>;

  /// `executor` may be null: then nothing is computed speculatively. `ends_sequence` returns true for a value after
  /// which the rest of a sequence is not needed; it is called with a lock held. Empty: no value ends a sequence.
  SpeculativeCache(std::shared_ptr<Executor> executor, Executor::Priority priority,
                   std::function<bool(const Value&)> ends_sequence = {})
      : executor_(std::move(executor)), priority_(priority), ends_sequence_(std::move(ends_sequence)) {}

  /// Cancels running computations and waits for them.
  ~SpeculativeCache() {
    std::unique_lock lock(mutex_);
    stop_ = true;
    wanted_.clear();
    for (auto& [key, entry] : entries_) entry.cancel.cancel();
    std::list<Task> tasks = std::move(tasks_);
    tasks_.clear();
    lock.unlock();
    tasks.clear();
  }
  SpeculativeCache(const SpeculativeCache&) = delete;
  SpeculativeCache& operator=(const SpeculativeCache&) = delete;

  bool computes_ahead() const { return executor_ && executor_->threads() > 1; }

  /// Replaces the sequences that idle threads work on, likeliest first. Cancels running computations that are in none
  /// of them and that no thread has asked for. Computed values stay. `context`: deadline of speculative computations.
  void prefetch(std::deque<Sequence> sequences, const RunContext& context) {
    if (!computes_ahead()) return;
    const std::scoped_lock lock(mutex_);
    wanted_ = std::move(sequences);
    deadline_ = context.deadline;
    for (Task& task : tasks_)
      if (task.key != nullptr && !entries_.at(*task.key).asked && !is_wanted(*task.key))
        entries_.at(*task.key).cancel.cancel();
    submit_tasks();
  }

  /// Moves the value out of the cache. Computes it on the calling thread if it is neither present nor being computed.
  /// Throws what the computation throws. If `context` asks to stop, returns the incomplete value of `compute`.
  Value get(const Key& key, const Compute& compute, const RunContext& context) {
    std::unique_lock lock(mutex_);
    Entry& entry = entries_[key];
    while (true) {
      if (entry.state == State::computed) {
        entry.state = State::taken;
        return take(entry);
      }
      if (entry.state != State::running) return compute_now(entry, compute, context, lock);
      if (entry.asked) throw std::logic_error("SpeculativeCache: two threads ask for the same key");
      entry.asked = true;
      Executor::TaskHandle handle = std::move(entry.task->handle);
      lock.unlock();
      handle.wait(context, entry.cancel);
      lock.lock();
      if (entry.state == State::interrupted && context.should_stop()) return take(entry);
    }
  }

  /// Also true for what get() has returned.
  bool is_computed(const Key& key) const {
    const std::scoped_lock lock(mutex_);
    const State state = state_of(key);
    return state == State::computed || state == State::taken;
  }
  bool is_running(const Key& key) const {
    const std::scoped_lock lock(mutex_);
    return state_of(key) == State::running;
  }
  /// Number of values that were computed and not asked for.
  std::uint64_t unused() const {
    const std::scoped_lock lock(mutex_);
    std::uint64_t count = 0;
    for (const auto& [key, entry] : entries_) count += entry.state == State::computed;
    return count;
  }
  /// Number of sequences that may have something left to compute.
  std::size_t waiting() const {
    const std::scoped_lock lock(mutex_);
    return wanted_.size();
  }

 private:
  enum class State : char { absent, running, computed, taken, interrupted, failed };
  struct Task {
    const Key* key = nullptr;     // what it computes; null before and after that
    Executor::TaskHandle handle;  // empty: the thread that asked has it. Last: its destructor waits for the task
  };
  struct Entry {
    State state = State::absent;
    bool asked = false;          // a thread waits for it, or computes it
    bool ends_sequence = false;  // result of ends_sequence_
    Task* task = nullptr;        // computes it; null: the asking thread does
    CancelToken cancel;
    std::optional<Value> value;
  };

  // All are called with the mutex locked; computations unlock it meanwhile.

  static Value take(Entry& entry) {
    Value value = std::move(*entry.value);
    entry.value.reset();
    return value;
  }

  State state_of(const Key& key) const {
    const auto found = entries_.find(key);
    return found == entries_.end() ? State::absent : found->second.state;
  }

  bool is_wanted(const Key& key) const {
    const auto is_key = [&key](const Request& r) { return !(r.key < key) && !(key < r.key); };
    for (const Sequence& sequence : wanted_)
      if (std::any_of(sequence.begin(), sequence.end(), is_key)) return true;
    return false;
  }

  /// The first request that can be computed now. Removes known requests from the front of the sequences.
  std::optional<Request> next_request() {
    for (Sequence& sequence : wanted_)
      while (!sequence.empty()) {
        const auto found = entries_.find(sequence.front().key);
        if (found == entries_.end()) return sequence.front();
        const Entry& entry = found->second;
        if (entry.state == State::absent || entry.state == State::interrupted) return sequence.front();
        if (entry.state == State::running) break;
        if (entry.state == State::failed || entry.ends_sequence)
          sequence.clear();
        else
          sequence.pop_front();
      }
    std::erase_if(wanted_, [](const Sequence& sequence) { return sequence.empty(); });
    return std::nullopt;
  }

  /// Each task runs one computation and then submits another task, so that more urgent ones come in between. There are
  /// as many as threads: when the asking thread waits for one, another takes its slot.
  void submit_tasks() {
    std::erase_if(tasks_, [](const Task& task) { return task.handle ? task.handle.done() : task.key == nullptr; });
    if (stop_ || !computes_ahead() || wanted_.empty()) return;
    while (pending_ < executor_->threads()) {
      ++pending_;
      Task& task = tasks_.emplace_back();
      task.handle = executor_->submit([this, &task] { compute_next(task); }, priority_);
    }
  }

  void compute_next(Task& task) {
    std::unique_lock lock(mutex_);
    if (deadline_.passed()) wanted_.clear();
    const std::optional<Request> request = stop_ ? std::nullopt : next_request();
    if (!request) {
      --pending_;
      return;
    }
    const auto found = entries_.try_emplace(request->key).first;
    Entry& entry = found->second;
    entry.state = State::running;
    entry.asked = false;
    entry.cancel = CancelToken();
    entry.task = &task;
    task.key = &found->first;
    RunContext context;
    context.deadline = deadline_;
    context.cancel = entry.cancel;
    context.executor = executor_;
    lock.unlock();
    std::optional<Value> value;
    try {
      value = request->compute(context);
    } catch (...) {
      // get() computes it again if it is asked for, and throws the same.
    }
    lock.lock();
    entry.state = !value ? State::failed : context.should_stop() ? State::interrupted : State::computed;
    entry.value = std::move(value);
    if (entry.state == State::computed) note_end(entry, *entry.value);
    entry.task = nullptr;
    task.key = nullptr;
    --pending_;
    submit_tasks();
  }

  Value compute_now(Entry& entry, const Compute& compute, const RunContext& context,
                    std::unique_lock<std::mutex>& lock) {
    entry.state = State::running;
    entry.asked = true;
    entry.task = nullptr;
    lock.unlock();
    std::optional<Value> value;
    try {
      value = compute(context);
    } catch (...) {
      lock.lock();
      entry.state = State::failed;
      throw;
    }
    lock.lock();
    entry.state = context.should_stop() ? State::interrupted : State::taken;
    entry.value.reset();
    note_end(entry, *value);
    if (entry.state == State::taken) submit_tasks();  // its sequence may continue
    return std::move(*value);
  }

  void note_end(Entry& entry, const Value& value) { entry.ends_sequence = ends_sequence_ && ends_sequence_(value); }

  const std::shared_ptr<Executor> executor_;
  const Executor::Priority priority_;
  const std::function<bool(const Value&)> ends_sequence_;
  mutable std::mutex mutex_;
  std::map<Key, Entry> entries_;  // never move
  std::deque<Sequence> wanted_;
  std::list<Task> tasks_;  // queued, running, and done
  unsigned pending_ = 0;   // tasks that are queued, or running and not about to end
  Deadline deadline_;
  bool stop_ = false;
};

}  // namespace dismantle
