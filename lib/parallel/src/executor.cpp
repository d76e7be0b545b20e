#include "dismantle/executor.h"

#include <signal.h>

#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

namespace dismantle {
namespace {

/// Stack for signal handlers (SA_ONSTACK) in a thread whose own stack may have overflowed. Without it, such a thread
/// ends the process before a handler can report the reason.
class SignalStack {
 public:
  SignalStack() {
    stack_t stack = {};
    stack.ss_sp = memory_.data();
    stack.ss_size = memory_.size();
    ::sigaltstack(&stack, nullptr);
  }
  ~SignalStack() {
    stack_t none = {};
    none.ss_flags = SS_DISABLE;
    ::sigaltstack(&none, nullptr);
  }
  SignalStack(const SignalStack&) = delete;
  SignalStack& operator=(const SignalStack&) = delete;

 private:
  std::vector<char> memory_ = std::vector<char>(1 << 16);
};

}  // namespace

struct Executor::Task {
  enum class State : char { queued, running, done, withdrawn };
  std::function<void()> work;
  State state = State::queued;
  bool awaited = false;     // by a thread that has released its slot
  bool hands_slot = false;  // passes its slot directly to that thread
  std::exception_ptr error;
};

struct Executor::Pool {
  explicit Pool(unsigned n) : threads(n) {}

  const unsigned threads;
  std::mutex mutex;
  std::condition_variable slot_or_task, task_ended, pause_ended;
  std::array<std::deque<std::shared_ptr<Task>>, 3> queues;  // by priority
  unsigned slots_taken = 1;
  unsigned asleep = 0;  // helpers that wait for a slot and a task
  unsigned pauses = 0;
  bool stop = false;
  std::vector<std::jthread> helpers;

  // These are called with the mutex locked.

  std::size_t queued() const { return queues[0].size() + queues[1].size() + queues[2].size(); }
  bool has_work() const { return slots_taken < threads && queued() > 0; }

  /// Call it when a slot or a task was added.
  void wake_helper() {
    if (!has_work() || stop) return;
    if (asleep > 0) slot_or_task.notify_one();
    // Up to twice as many helpers as slots, because helpers may block while they wait for each other's tasks.
    if (std::min<std::size_t>(queued(), threads - slots_taken) > asleep && helpers.size() < 2 * std::size_t{threads})
      helpers.emplace_back([this] { help(); });
  }

  void release_slot() {
    --slots_taken;
    wake_helper();
  }

  std::shared_ptr<Task> next_task() {
    auto& queue = *std::find_if(queues.begin(), queues.end(), [](const auto& q) { return !q.empty(); });
    std::shared_ptr<Task> task = std::move(queue.front());
    queue.pop_front();
    return task;
  }

  /// Waits for the task and calls `poll` at intervals of `every`. Returns what the task threw.
  std::exception_ptr wait_for(Task& task, std::chrono::milliseconds every, const std::function<void()>& poll) {
    std::unique_lock lock(mutex);
    const auto done = [&task] { return task.state == Task::State::done; };
    if (done()) return task.error;
    task.awaited = true;
    release_slot();
    while (!task_ended.wait_for(lock, every, done)) {
      lock.unlock();
      poll();
      lock.lock();
    }
    if (!task.hands_slot) ++slots_taken;
    task.awaited = task.hands_slot = false;
    return task.error;
  }

  // This one is called without it.

  void help() {
    const SignalStack stack;
    std::unique_lock lock(mutex);
    while (true) {
      ++asleep;
      slot_or_task.wait(lock, [this] { return stop || has_work(); });
      --asleep;
      if (stop) return;
      const std::shared_ptr<Task> task = next_task();
      task->state = Task::State::running;
      ++slots_taken;
      lock.unlock();
      try {
        task->work();
      } catch (...) {
        task->error = std::current_exception();  // rethrown by wait()
      }
      task->work = nullptr;  // frees what it captured
      lock.lock();
      task->state = Task::State::done;
      task->hands_slot = task->awaited;
      task_ended.notify_all();
      if (!task->hands_slot) release_slot();
    }
  }
};

Executor::TaskHandle& Executor::TaskHandle::operator=(TaskHandle&& other) noexcept {
  std::swap(pool_, other.pool_);
  std::swap(task_, other.task_);
  return *this;
}

Executor::TaskHandle::~TaskHandle() {
  if (!task_ || withdraw()) return;
  std::unique_lock lock(pool_->mutex);
  pool_->task_ended.wait(lock, [this] { return task_->state != Task::State::running; });
}

bool Executor::TaskHandle::withdraw() {
  const std::scoped_lock lock(pool_->mutex);
  if (task_->state == Task::State::queued) {
    for (auto& queue : pool_->queues) std::erase(queue, task_);
    task_->state = Task::State::withdrawn;
  }
  return task_->state == Task::State::withdrawn;
}

bool Executor::TaskHandle::done() const {
  const std::scoped_lock lock(pool_->mutex);
  return task_->state == Task::State::done;
}

void Executor::TaskHandle::wait() {
  // The end of the task wakes the caller; the period does not matter.
  if (const auto error = pool_->wait_for(*task_, std::chrono::seconds(1), [] {})) std::rethrow_exception(error);
}

void Executor::TaskHandle::wait(const RunContext& context, const CancelToken& cancel) {
  // The caller's flag and deadline cannot wake a sleeper, so they are polled. The interval affects how soon an
  // interruption is noticed, never a result.
  const auto poll = [&] {
    if (context.should_stop()) cancel.cancel();
  };
  if (const auto error = pool_->wait_for(*task_, std::chrono::milliseconds(5), poll)) std::rethrow_exception(error);
}

Executor::BlockingScope::BlockingScope(Executor* executor) : executor_(executor) {
  if (executor_ == nullptr) return;
  const std::scoped_lock lock(executor_->pool_->mutex);
  executor_->pool_->release_slot();
}

Executor::BlockingScope::~BlockingScope() {
  if (executor_ == nullptr) return;
  const std::scoped_lock lock(executor_->pool_->mutex);
  ++executor_->pool_->slots_taken;
}

Executor::PauseScope::PauseScope(Executor& executor) : executor_(executor) {
  const std::scoped_lock lock(executor_.pool_->mutex);
  ++executor_.pool_->pauses;
}

Executor::PauseScope::~PauseScope() {
  const std::scoped_lock lock(executor_.pool_->mutex);
  --executor_.pool_->pauses;
  executor_.pool_->pause_ended.notify_all();
}

Executor::Executor(unsigned threads) {
  if (threads < 1) throw std::invalid_argument("Executor: at least one thread");
  pool_ = std::make_shared<Pool>(threads);
}

Executor::~Executor() {
  {
    const std::scoped_lock lock(pool_->mutex);
    pool_->stop = true;  // no helper is added any more
    for (auto& queue : pool_->queues) {
      for (const auto& task : queue) task->state = Task::State::withdrawn;
      queue.clear();
    }
  }
  pool_->slot_or_task.notify_all();
  pool_->helpers.clear();
}

unsigned Executor::threads() const { return pool_->threads; }

Executor::TaskHandle Executor::submit(std::function<void()> work, Priority priority) {
  auto task = std::make_shared<Task>();
  task->work = std::move(work);
  const std::scoped_lock lock(pool_->mutex);
  if (pool_->stop)
    task->state = Task::State::withdrawn;
  else
    pool_->queues[static_cast<std::size_t>(priority)].push_back(task);
  pool_->wake_helper();
  return {pool_, std::move(task)};
}

void Executor::pause_point() {
  std::unique_lock lock(pool_->mutex);
  if (pool_->pauses == 0) return;
  pool_->release_slot();
  pool_->pause_ended.wait(lock, [this] { return pool_->pauses == 0; });
  ++pool_->slots_taken;
}

void pause_point(const RunContext& context) {
  if (context.speculative && context.executor) context.executor->pause_point();
}

}  // namespace dismantle
