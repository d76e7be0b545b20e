/// The thread pool of a run: fork-join parallelism, and speculative tasks for threads that would be idle.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// A work-sharing thread pool. At most `threads` threads run at the same time; each running thread holds one slot, and
/// the thread that creates the executor holds the first. A thread that waits for a task releases its slot meanwhile.
/// Scheduling is nondeterministic, and a task may never be started, so no result may depend on which thread runs a
/// task, or when: callers run a task themselves if no thread has begun it.
class DISMANTLE_API Executor {
  struct Task;
  struct Pool;

 public:
  /// The order in which free slots are given to queued tasks; within a priority: first come, first served.
  enum class Priority : char {
    fork_join,    ///< part of the work of a running thread, which waits for it
    speculative,  ///< will probably be needed soon
    idle,         ///< long task that may be needed later
  };

  /// Handle of a submitted task. The destructor withdraws the task, or waits for its end. May outlive the executor.
  class DISMANTLE_API TaskHandle {
   public:
    TaskHandle() = default;  ///< no task: only assignment and destruction are allowed
    TaskHandle(TaskHandle&&) noexcept = default;
    TaskHandle& operator=(TaskHandle&& other) noexcept;
    ~TaskHandle();
    explicit operator bool() const { return task_ != nullptr; }  ///< false: no task
    /// True: the task was not started, and will not be. False: it is running or done.
    bool withdraw();
    bool done() const;
    /// Blocks until the task is done; throws what it threw. The task must not be withdrawn, and only one thread may
    /// wait. The caller's slot is free meanwhile; at the end it takes over the slot of the thread that ran the task.
    void wait();
    /// As wait(). When `context` asks to stop, sets `cancel` within about 5 ms; the task must obey it.
    void wait(const RunContext& context, const CancelToken& cancel);

   private:
    friend class Executor;
    TaskHandle(std::shared_ptr<Pool> pool, std::shared_ptr<Task> task)
        : pool_(std::move(pool)), task_(std::move(task)) {}
    std::shared_ptr<Pool> pool_;
    std::shared_ptr<Task> task_;
  };

  /// Frees the slot of the calling thread while it exists, for waits on something other than a task.
  class DISMANTLE_API BlockingScope {
   public:
    explicit BlockingScope(Executor* executor);  ///< null: nothing happens
    ~BlockingScope();                            ///< does not wait for a slot: for a short time one more thread may run
    BlockingScope(const BlockingScope&) = delete;
    BlockingScope& operator=(const BlockingScope&) = delete;

   private:
    Executor* executor_;
  };

  /// While it exists, threads that reach a pause_point() wait there, so that their slots serve the more urgent work of
  /// the calling thread. That thread must not wait for them.
  class DISMANTLE_API PauseScope {
   public:
    explicit PauseScope(Executor& executor);
    ~PauseScope();
    PauseScope(const PauseScope&) = delete;
    PauseScope& operator=(const PauseScope&) = delete;

   private:
    Executor& executor_;
  };

  explicit Executor(unsigned threads);  ///< >= 1; with 1 no task is ever run. Throws std::invalid_argument
  /// Withdraws tasks that were not started, and waits for the others.
  ~Executor();
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  unsigned threads() const;
  /// Everything that `work` refers to must outlive the handle.
  [[nodiscard]] TaskHandle submit(std::function<void()> work, Priority priority);
  /// For long tasks whose result may not be needed: blocks while a PauseScope exists; the slot is free meanwhile.
  void pause_point();

 private:
  std::shared_ptr<Pool> pool_;
};

/// For long speculative work (RunContext::speculative): waits while a thread of the executor does more urgent work
/// (Executor::PauseScope). Otherwise does nothing.
DISMANTLE_API void pause_point(const RunContext& context);

namespace detail {

/// A loop whose indices are handed out to several threads until stop().
template <class Work, class Stop>
class SharedLoop {
 public:
  SharedLoop(std::size_t n, Work& work, Stop& stop) : n_(n), work_(work), stop_(stop), errors_(n) {}
  void run() {
    while (!stop_()) {  // checked before taking an index: each taken index is completed, and so are all below it
      const std::size_t i = next_++;
      if (i >= n_) return;
      try {
        work_(i);
      } catch (...) {
        errors_[i] = std::current_exception();  // thrown by check()
      }
    }
  }
  void check() const {
    for (const auto& error : errors_)
      if (error) std::rethrow_exception(error);
  }

 private:
  const std::size_t n_;
  Work& work_;
  Stop& stop_;
  std::atomic<std::size_t> next_{0};
  std::vector<std::exception_ptr> errors_;
};

}  // namespace detail

/// Calls work(i) for i in [0, n), begun in ascending order, on the calling thread and on idle threads of the executor
/// (null: none), until stop(), which all of them call. If work(i) was called, so was work() for all lower indices. An
/// exception does not end the loop; the one with the lowest index is thrown after the loop.
template <class Work, class Stop>
void parallel_for(std::size_t n, Executor* executor, Work&& work, Stop&& stop) {
  detail::SharedLoop loop(n, work, stop);
  {
    std::vector<Executor::TaskHandle> helpers;  // withdrawn if the loop ends before they begin
    if (executor != nullptr)
      for (std::size_t i = 1; i < std::min<std::size_t>(executor->threads(), n); ++i)
        helpers.push_back(executor->submit([&] { loop.run(); }, Executor::Priority::fork_join));
    loop.run();
    for (auto& helper : helpers)
      if (!helper.withdraw()) helper.wait();
  }
  loop.check();
}

/// The same on the context's executor, or on a temporary one if there is none and RunContext::threads > 1.
template <class Work, class Stop>
void parallel_for(std::size_t n, const RunContext& context, Work&& work, Stop&& stop) {
  if (context.executor || context.threads < 2 || n < 2) return parallel_for(n, context.executor.get(), work, stop);
  Executor own(static_cast<unsigned>(std::min<std::size_t>(context.threads, n)));
  parallel_for(n, &own, work, stop);
}

/// Repeatedly runs two functions in parallel. Meant for functions so short that waking a thread would take longer: it
/// keeps the first idle thread of the context's executor until it is destroyed. Until there is one, both functions run
/// on the calling thread.
class DISMANTLE_API ForkJoin {
 public:
  explicit ForkJoin(const RunContext& context);
  ~ForkJoin();
  ForkJoin(const ForkJoin&) = delete;
  ForkJoin& operator=(const ForkJoin&) = delete;
  /// Returns when both are done. Then throws what either threw; an exception of `first` takes precedence.
  void operator()(const std::function<void()>& first, const std::function<void()>& second);

 private:
  struct Helper;
  std::unique_ptr<Helper> helper_;
};

}  // namespace dismantle
