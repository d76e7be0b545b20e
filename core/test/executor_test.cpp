#include "dismantle/executor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

namespace dismantle {
namespace {

using Priority = Executor::Priority;
using TaskHandle = Executor::TaskHandle;
constexpr Priority kPriorities[] = {Priority::fork_join, Priority::speculative, Priority::idle};

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

void yield_times(int n) {
  for (int k = 0; k < n; ++k) std::this_thread::yield();
}

TEST(Executor, NeedsAThread) { EXPECT_THROW(Executor(0), std::invalid_argument); }

TEST(Executor, EachTaskRunsOnceUnlessItIsWithdrawn) {
  Rng rng(5);
  for (const unsigned threads : {1U, 2U, 4U}) {
    Executor executor(threads);
    EXPECT_EQ(executor.threads(), threads);
    for (int trial = 0; trial < 200; ++trial) {
      constexpr int kTasks = 6;
      std::atomic<int> runs[kTasks] = {};
      std::vector<TaskHandle> handles;
      for (auto& run : runs) handles.push_back(executor.submit([&run] { ++run; }, kPriorities[rng.below(3)]));
      bool withdrawn[kTasks] = {};
      for (int k = 0; k < kTasks; ++k) {
        if (rng.uniform() < 0.5 && handles[k].withdraw()) {
          withdrawn[k] = true;
          EXPECT_TRUE(handles[k].withdraw()) << "it stays withdrawn";
        } else if (threads > 1) {
          handles[k].wait();
          EXPECT_TRUE(handles[k].done());
          EXPECT_FALSE(handles[k].withdraw());
        }
      }
      handles.clear();
      for (int k = 0; k < kTasks; ++k) EXPECT_EQ(runs[k], threads > 1 && !withdrawn[k] ? 1 : 0);
    }
  }
}

/// Destroying a handle leaves no task that could still touch what it referred to.
TEST(Executor, TheHandleOutlivesTheTask) {
  Rng rng(8);
  Executor executor(3);
  for (int trial = 0; trial < 500; ++trial) {
    auto value = std::make_unique<int>(0);
    {
      std::vector<TaskHandle> handles;
      for (int k = 0; k < 3; ++k)
        handles.push_back(executor.submit([p = value.get(), k] { yield_times(k), p[0] += 0; }, kPriorities[k]));
      yield_times(static_cast<int>(rng.below(4)));
    }
    value.reset();
  }
}

TEST(Executor, NoMoreTasksRunThanThereAreSlots) {
  for (const unsigned threads : {2U, 3U, 5U}) {
    Executor executor(threads);
    Gauge gauge(1);
    std::vector<TaskHandle> handles;
    for (int k = 0; k < 60; ++k)
      handles.push_back(executor.submit(
          [&gauge] {
            gauge.enter();
            yield_times(10);
            gauge.leave();
          },
          kPriorities[k % 3]));
    for (auto& handle : handles)
      while (!handle.done()) std::this_thread::yield();
    EXPECT_LE(gauge.most(), static_cast<int>(threads));
    EXPECT_GT(gauge.most(), 1);
  }
}

TEST(Executor, PriorityComesBeforeTheOrderOfSubmission) {
  Executor executor(2);
  std::latch begun(1), free(1);
  TaskHandle first = executor.submit([&] { begun.count_down(), free.wait(); }, Priority::fork_join);
  begun.wait();
  std::vector<int> order;
  std::vector<TaskHandle> handles;
  for (int k = 0; k < 9; ++k)
    handles.push_back(executor.submit([&order, k] { order.push_back(k); }, kPriorities[2 - k % 3]));
  free.count_down();
  for (auto& handle : handles)  // wait() would free another slot
    while (!handle.done()) std::this_thread::yield();
  EXPECT_EQ(order, (std::vector<int>{2, 5, 8, 1, 4, 7, 0, 3, 6}));
}

TEST(Executor, AThreadThatWaitsReleasesItsSlot) {
  Executor executor(2);
  std::latch begun(1), met(2);
  TaskHandle one = executor.submit([&] { begun.count_down(), met.arrive_and_wait(); }, Priority::idle);
  begun.wait();
  TaskHandle other = executor.submit([&] { met.arrive_and_wait(); }, Priority::idle);
  yield_times(100);
  EXPECT_TRUE(!met.try_wait()) << "both slots are taken";
  one.wait();  // else they never meet
  other.wait();
}

/// A thread that waits takes over the slot of the task: at no time do more run than there are slots, though tasks stand
/// ready to take each slot that becomes free.
TEST(Executor, TheSlotOfATaskIsHandedToTheThreadThatWaitsForIt) {
  Executor executor(2);
  Gauge gauge(1);
  const auto work = [&gauge](int turns) {
    gauge.enter();
    yield_times(turns);
    gauge.leave();
  };
  for (int round = 0; round < 300; ++round) {
    std::latch begun(1);
    std::vector<TaskHandle> later;
    TaskHandle task = executor.submit(
        [&] {
          gauge.enter();
          begun.count_down();
          yield_times(50);
          gauge.leave();
        },
        Priority::fork_join);
    begun.wait();
    for (int k = 0; k < 2; ++k) later.push_back(executor.submit([&] { work(200); }, Priority::speculative));
    gauge.leave();
    task.wait();
    gauge.enter();
  }
  EXPECT_LE(gauge.most(), 2);
}

TEST(Executor, ABlockingScopeReleasesTheSlot) {
  Executor executor(2);
  for (int trial = 0; trial < 100; ++trial) {
    std::latch begun(1), met(2);
    TaskHandle one = executor.submit([&] { begun.count_down(), met.arrive_and_wait(); }, Priority::idle);
    begun.wait();
    TaskHandle other = executor.submit([&] { met.arrive_and_wait(); }, Priority::idle);
    {
      const Executor::BlockingScope blocking(&executor);
      met.wait();
    }
    one.wait();
    other.wait();
  }
  const Executor::BlockingScope none(nullptr);
}

/// Tasks that wait for tasks of their own, on every level, whatever number of threads there are.
TEST(Executor, NestedTasksDoNotDeadlock) {
  for (const unsigned threads : {2U, 3U, 4U}) {
    Executor executor(threads);
    std::atomic<int> leaves{0};
    const std::function<void(int)> descend = [&](int depth) {
      if (depth == 0) {
        ++leaves;
        return;
      }
      TaskHandle other = executor.submit([&] { descend(depth - 1); }, Priority::fork_join);
      descend(depth - 1);
      if (other.withdraw())
        descend(depth - 1);
      else
        other.wait();
    };
    for (int trial = 0; trial < 20; ++trial) {
      leaves = 0;
      descend(7);
      EXPECT_EQ(leaves, 1 << 7);
    }
  }
}

TEST(Executor, WhatATaskThrowsIsThrownByWait) {
  Executor executor(2);
  TaskHandle handle = executor.submit([] { throw std::runtime_error("no"); }, Priority::fork_join);
  EXPECT_THROW(handle.wait(), std::runtime_error);
  {
    const TaskHandle dropped = executor.submit([] { throw std::runtime_error("no"); }, Priority::fork_join);
  }
  TaskHandle next = executor.submit([] {}, Priority::fork_join);
  EXPECT_NO_THROW(next.wait());
}

TEST(Executor, WaitPassesOnThatTheContextSaysToStop) {
  Executor executor(2);
  for (const bool by_deadline : {false, true}) {
    RunContext context;
    CancelToken cancel;
    std::latch begun(1);
    TaskHandle handle = executor.submit(
        [&] {
          begun.count_down();
          while (!cancel.cancelled()) std::this_thread::yield();
        },
        Priority::idle);
    begun.wait();
    if (by_deadline)
      context.deadline = Deadline::after_seconds(0);
    else
      context.cancel.cancel();
    handle.wait(context, cancel);
    EXPECT_TRUE(handle.done());
  }
}

TEST(Executor, HandlesMayOutliveIt) {
  TaskHandle never, perhaps;
  std::atomic<int> runs{0};
  {
    Executor serial(1), executor(3);
    never = serial.submit([] { FAIL() << "there is no thread for it"; }, Priority::fork_join);
    perhaps = executor.submit([&] { ++runs; }, Priority::fork_join);
  }
  EXPECT_TRUE(never.withdraw());
  EXPECT_EQ(perhaps.withdraw(), runs == 0);
}

TEST(Executor, TasksPauseWhileAPauseScopeExists) {
  Executor executor(2);
  std::atomic<bool> over{false};
  std::atomic<int> rounds{0};
  TaskHandle task = executor.submit(
      [&] {
        while (!over) {
          executor.pause_point();
          ++rounds;
        }
      },
      Priority::fork_join);
  while (rounds == 0) std::this_thread::yield();
  for (int k = 0; k < 20; ++k) {
    {
      const Executor::PauseScope pause(executor);
      const Executor::PauseScope nested(executor);
      TaskHandle urgent = executor.submit([] {}, Priority::fork_join);
      while (!urgent.done()) std::this_thread::yield();  // in the slot of the task that pauses
      const int before = rounds;
      yield_times(100);
      EXPECT_EQ(rounds, before);
    }
    const int before = rounds;
    while (rounds == before) std::this_thread::yield();  // it goes on
  }
  over = true;
  task.wait();
}

// ---- parallel_for

const auto kNever = [] { return false; };

TEST(ParallelFor, CallsEachIndexOnce) {
  Rng rng(2);
  for (const unsigned threads : {0U, 1U, 2U, 4U}) {
    const auto executor = threads > 0 ? std::make_unique<Executor>(threads) : nullptr;
    for (int trial = 0; trial < 50; ++trial) {
      std::vector<int> calls(rng.below(40));  // no atomics: each is written by one thread, and read after the loop
      parallel_for(
          calls.size(), executor.get(), [&](std::size_t i) { ++calls[i]; }, kNever);
      for (const int n : calls) EXPECT_EQ(n, 1);
    }
  }
}

TEST(ParallelFor, WithoutAnExecutorItStartsAsManyThreadsAsTheContextAllows) {
  for (const unsigned threads : {1U, 3U}) {
    RunContext context;
    context.threads = threads;
    Gauge gauge;
    std::atomic<int> calls{0};
    parallel_for(
        50, context,
        [&](std::size_t) {
          gauge.enter();
          for (int k = 0; k < 20'000 && gauge.most() < static_cast<int>(threads); ++k) std::this_thread::yield();
          ++calls;
          gauge.leave();
        },
        kNever);
    EXPECT_EQ(calls, 50);
    EXPECT_EQ(gauge.most(), static_cast<int>(threads));
  }
}

TEST(ParallelFor, ThrowsTheExceptionOfTheLowestIndexAfterTheLoop) {
  Rng rng(3);
  for (const unsigned threads : {1U, 2U, 4U}) {
    Executor executor(threads);
    for (int trial = 0; trial < 50; ++trial) {
      std::vector<char> fails(20);
      for (auto& f : fails) f = rng.uniform() < 0.2;
      fails[rng.below(fails.size())] = 1;
      std::atomic<int> calls{0};
      const auto lowest = static_cast<std::size_t>(std::find(fails.begin(), fails.end(), 1) - fails.begin());
      try {
        parallel_for(
            fails.size(), &executor,
            [&](std::size_t i) {
              ++calls;
              if (fails[i]) throw i;
            },
            kNever);
        FAIL() << "it throws";
      } catch (const std::size_t thrown) {
        EXPECT_EQ(thrown, lowest);
      }
      EXPECT_EQ(calls, 20);
    }
  }
}

TEST(ParallelFor, BeginsNothingAfterStop) {
  Executor executor(3);
  for (int trial = 0; trial < 100; ++trial) {
    std::atomic<bool> stop{false};
    std::vector<char> done(1000);
    parallel_for(
        done.size(), &executor,
        [&](std::size_t i) {
          done[i] = 1;
          if (i == 10) stop = true;
        },
        [&] { return stop.load(); });
    EXPECT_EQ(std::accumulate(done.begin(), done.begin() + 11, 0), 11) << "they begin in ascending order";
    EXPECT_LT(std::accumulate(done.begin(), done.end(), 0), 1000);
  }
}

TEST(ParallelFor, Nests) {
  for (const unsigned threads : {2U, 4U}) {
    Executor executor(threads);
    for (int trial = 0; trial < 20; ++trial) {
      std::vector<std::vector<int>> calls(6, std::vector<int>(7));
      parallel_for(
          calls.size(), &executor,
          [&](std::size_t i) {
            parallel_for(
                calls[i].size(), &executor, [&](std::size_t k) { ++calls[i][k]; }, kNever);
          },
          kNever);
      for (const auto& row : calls) EXPECT_EQ(row, std::vector<int>(7, 1));
    }
  }
}

// ---- ForkJoin

RunContext context_with(unsigned threads) {
  RunContext context;
  if (threads > 0) context.executor = std::make_shared<Executor>(threads);
  return context;
}

TEST(ForkJoin, BothAreDoneOnceEachTime) {
  Rng rng(3);
  for (const unsigned threads : {0U, 1U, 2U, 3U}) {
    const RunContext context = context_with(threads);
    for (int trial = 0; trial < 20; ++trial) {
      ForkJoin fork_join(context);
      const int rounds = static_cast<int>(rng.below(50));
      int first = 0, second = 0;  // no atomics: each is done before the call returns
      for (int k = 0; k < rounds; ++k) {
        fork_join([&] { ++first; }, [&] { ++second; });
        ASSERT_EQ(first, k + 1);
        ASSERT_EQ(second, k + 1);
        if (k % 10 == 0) std::this_thread::yield();
      }
    }
  }
}

TEST(ForkJoin, KeepsAThreadForTheSecond) {
  const RunContext context = context_with(2);
  ForkJoin fork_join(context);
  std::thread::id first, second;
  const auto run = [&] {
    fork_join([&] { first = std::this_thread::get_id(); }, [&] { second = std::this_thread::get_id(); });
  };
  do {
    run();
  } while (first == second);  // until the thread is there
  EXPECT_EQ(first, std::this_thread::get_id());
  const std::thread::id helper = second;
  for (int k = 0; k < 50; ++k) {
    run();
    EXPECT_EQ(second, helper);
  }
}

TEST(ForkJoin, ThrowsWhenBothAreDoneTheFirstBeforeTheSecond) {
  for (const unsigned threads : {0U, 2U, 3U}) {
    const RunContext context = context_with(threads);
    ForkJoin fork_join(context);
    for (int k = 0; k < 50; ++k) {
      std::atomic<bool> done{false};
      EXPECT_THROW(fork_join([&] { done = true; }, [] { throw std::runtime_error("no"); }), std::runtime_error);
      EXPECT_TRUE(done);
      EXPECT_THROW(fork_join([] { throw std::logic_error("no"); }, [] { throw std::runtime_error("no"); }),
                   std::logic_error);
      EXPECT_NO_THROW(fork_join([] {}, [] {}));
    }
  }
}

TEST(ForkJoin, SeveralShareAnExecutor) {
  Executor* const none = nullptr;
  for (const unsigned threads : {2U, 3U}) {
    const RunContext context = context_with(threads);
    std::atomic<int> sum{0};
    parallel_for(
        5, context,
        [&](std::size_t) {
          ForkJoin fork_join(context);
          for (int k = 0; k < 100; ++k) fork_join([&] { ++sum; }, [&] { ++sum; });
        },
        kNever);
    EXPECT_EQ(sum, 1000);
  }
  parallel_for(
      0, none, [](std::size_t) { FAIL() << "there is nothing to do"; }, kNever);
}

}  // namespace
}  // namespace dismantle
