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
    fork_join,    ///< part of the work of a running thread, which will wait for it
    speculative,  ///< will probably be needed soon
    idle,         ///< may be needed some time; long
  };

  /// Handle of a submitted task. The destructor withdraws the task, or waits for its end. May outlive the executor.
  class DISMANTLE_API TaskHandle {
   public:
    TaskHandle() = default;  ///< of no task: nothing but assignment and destruction is allowed
    TaskHandle(TaskHandle&&) noexcept = default;
    TaskHandle& operator=(TaskHandle&& other) noexcept;
    ~TaskHandle();
    explicit operator bool() const { return task_ != nullptr; }  ///< false: of no task
    /// True: the task was not started, and will not be. False: it is running or done.
    bool withdraw();
    bool done() const;
    /// Blocks until the task, which was not withdrawn, is done; throws what it threw. One thread at a time. The slot of
    /// the calling thread is free meanwhile; at the end the caller takes over the slot of the thread that ran the task.
    void wait();
    /// As wait(); when `context` says to stop, `cancel`, which the task is to obey, is set (within about 5 ms).
    void wait(const RunContext& context, const CancelToken& cancel);

   private:
    friend class Executor;
    TaskHandle(std::shared_ptr<Pool> pool, std::shared_ptr<Task> task)
        : pool_(std::move(pool)), task_(std::move(task)) {}
    std::shared_ptr<Pool> pool_;
    std::shared_ptr<Task> task_;
  };

  /// While it exists, the slot of the calling thread is free: for waits on something other than a task.
  class DISMANTLE_API BlockingScope {
   public:
    explicit BlockingScope(Executor* executor);  ///< null: nothing happens
    ~BlockingScope();                            ///< does not wait for a slot: for a short time one more thread may run
    BlockingScope(const BlockingScope&) = delete;
    BlockingScope& operator=(const BlockingScope&) = delete;

   private:
    Executor* executor_;
  };

  /// While it exists, threads that come to a pause_point() wait there: their slots serve the more urgent work of the
  /// calling thread, which must not wait for such a thread.
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
  /// `work` must not outlive what it refers to: keep the handle at least as long.
  [[nodiscard]] TaskHandle submit(std::function<void()> work, Priority priority);
  /// For long tasks whose result may turn out not to be needed: blocks, with its slot free, while a PauseScope exists.
  void pause_point();

 private:
  std::shared_ptr<Pool> pool_;
};

/// For long work that may turn out not to be needed (RunContext::speculative): waits while a thread of the executor
/// does something more urgent (Executor::PauseScope). Else nothing.
DISMANTLE_API void pause_point(const RunContext& context);

namespace detail {

/// The indices of a loop, taken by one thread after the other until stop().
template <class Work, class Stop>
class SharedLoop {
 public:
  SharedLoop(std::size_t n, Work& work, Stop& stop) : n_(n), work_(work), stop_(stop), errors_(n) {}
  void run() {
    while (!stop_()) {  // before an index is taken: what is taken is done, so all indices below it are
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

/// Calls work(i) for i in [0, n) in ascending order of beginning, on the calling thread and on idle threads of the
/// executor (null: none), until stop(), which is called from all of them. All indices below one for which work() was
/// called have been worked on, too. Of several exceptions the one with the lowest index is thrown, after the loop; it
/// does not end the loop.
template <class Work, class Stop>
void parallel_for(std::size_t n, Executor* executor, Work&& work, Stop&& stop) {
  detail::SharedLoop loop(n, work, stop);
  {
    std::vector<Executor::TaskHandle> helpers;  // which are withdrawn when the loop is over before they begin
    if (executor != nullptr)
      for (std::size_t i = 1; i < std::min<std::size_t>(executor->threads(), n); ++i)
        helpers.push_back(executor->submit([&] { loop.run(); }, Executor::Priority::fork_join));
    loop.run();
    for (auto& helper : helpers)
      if (!helper.withdraw()) helper.wait();
  }
  loop.check();
}

/// The same on the context's executor. Without one and with RunContext::threads > 1 on a temporary one.
template <class Work, class Stop>
void parallel_for(std::size_t n, const RunContext& context, Work&& work, Stop&& stop) {
  if (context.executor || context.threads < 2 || n < 2) return parallel_for(n, context.executor.get(), work, stop);
  Executor own(static_cast<unsigned>(std::min<std::size_t>(context.threads, n)));
  parallel_for(n, &own, work, stop);
}

/// Runs two functions at the same time, again and again. Made for functions so short that waking a thread would take
/// longer: one thread of the context's executor, once one is idle, is kept until the object is destroyed. As long as
/// there is none, both functions run on the calling thread.
class DISMANTLE_API ForkJoin {
 public:
  explicit ForkJoin(const RunContext& context);
  ~ForkJoin();
  ForkJoin(const ForkJoin&) = delete;
  ForkJoin& operator=(const ForkJoin&) = delete;
  /// Returns when both are done; then throws what either threw, the first one's before the second's.
  void operator()(const std::function<void()>& first, const std::function<void()>& second);

 private:
  struct Helper;
  std::unique_ptr<Helper> helper_;
};

}  // namespace dismantle
