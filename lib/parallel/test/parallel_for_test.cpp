// Loops and fork-join on an executor.
#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "dismantle/executor.h"
#include "dismantle/run_context.h"
#include "gauge.h"

namespace dismantle {
namespace {

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
