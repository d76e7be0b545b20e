#include "dismantle/executor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "gauge.h"

namespace dismantle {
namespace {

using Priority = Executor::Priority;
using TaskHandle = Executor::TaskHandle;
constexpr Priority kPriorities[] = {Priority::fork_join, Priority::speculative, Priority::idle};

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

/// After a handle is destroyed, its task no longer accesses anything.
TEST(Executor, TheHandleOutlivesTheTask) {
  Rng rng(8);
  Executor executor(3);
  for (int trial = 0; trial < 200; ++trial) {
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
    for (int k = 0; k < 30; ++k)
      handles.push_back(executor.submit(
          [&gauge] {
            gauge.enter();
            yield_times(4);
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

/// A thread that waits takes over the slot of the task: never do more threads run than there are slots, even with tasks
/// ready to take each slot that becomes free.
TEST(Executor, TheSlotOfATaskIsHandedToTheThreadThatWaitsForIt) {
  Executor executor(2);
  Gauge gauge(1);
  const auto work = [&gauge](int turns) {
    gauge.enter();
    yield_times(turns);
    gauge.leave();
  };
  for (int round = 0; round < 60; ++round) {
    std::latch begun(1);
    std::vector<TaskHandle> later;
    TaskHandle task = executor.submit(
        [&] {
          gauge.enter();
          begun.count_down();
          yield_times(5);
          gauge.leave();
        },
        Priority::fork_join);
    begun.wait();
    for (int k = 0; k < 2; ++k) later.push_back(executor.submit([&] { work(20); }, Priority::speculative));
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
  for (int k = 0; k < 10; ++k) {
    {
      const Executor::PauseScope pause(executor);
      const Executor::PauseScope nested(executor);
      TaskHandle urgent = executor.submit([] {}, Priority::fork_join);
      while (!urgent.done()) std::this_thread::yield();  // in the slot of the task that pauses
      const int before = rounds;
      yield_times(20);
      EXPECT_EQ(rounds, before);
    }
    const int before = rounds;
    while (rounds == before) std::this_thread::yield();  // it goes on
  }
  over = true;
  task.wait();
}

}  // namespace
}  // namespace dismantle
