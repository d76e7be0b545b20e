// A value that several threads ask for.
#include "dismantle/computed_once.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace dismantle {
namespace {

TEST(ComputedOnce, IsTheSameForAllThreads) {
  for (int trial = 0; trial < 50; ++trial) {
    ComputedOnce<int> value;
    std::atomic<int> computed{0};
    std::vector<const int*> seen(4);
    {
      std::vector<std::jthread> threads;
      for (const int*& mine : seen)
        threads.emplace_back([&] {
          mine = value.get(RunContext{}, [&] {
            std::this_thread::yield();
            return std::optional(10 + computed++);
          });
        });
    }
    EXPECT_EQ(computed, 1);
    EXPECT_EQ(std::set(seen.begin(), seen.end()).size(), 1u);
    ASSERT_NE(seen[0], nullptr);
    EXPECT_EQ(*seen[0], 10);
  }
}

/// The first few calls return nothing or throw, each only for its own caller.
TEST(ComputedOnce, WhereNothingIsComputedTheNextTriesAgain) {
  for (int trial = 0; trial < 50; ++trial) {
    ComputedOnce<int> value;
    std::atomic<int> asked{0}, nothing{0}, failed{0}, found{0};
    {
      std::vector<std::jthread> threads;
      for (int k = 0; k < 5; ++k)
        threads.emplace_back([&] {
          try {
            const int* mine = value.get(RunContext{}, [&]() -> std::optional<int> {
              std::this_thread::yield();
              const int turn = asked++;
              if (turn == 0) return std::nullopt;
              if (turn == 1) throw std::runtime_error("no");
              return turn;
            });
            ++(mine == nullptr ? nothing : found);
            if (mine != nullptr) {
              EXPECT_EQ(*mine, 2);
            }
          } catch (const std::runtime_error&) {
            ++failed;
          }
        });
    }
    EXPECT_EQ(asked, 3);
    EXPECT_EQ(nothing, 1);
    EXPECT_EQ(failed, 1);
    EXPECT_EQ(found, 3);
  }
}

TEST(ComputedOnce, AThreadThatWaitsReleasesItsSlot) {
  RunContext context;
  context.executor = std::make_shared<Executor>(2);
  for (int trial = 0; trial < 20; ++trial) {
    ComputedOnce<int> value;
    std::atomic<bool> asks{false};
    Executor::TaskHandle other;
    const int* mine = value.get(context, [&] {
      other = context.executor->submit(
          [&] {
            asks = true;
            const int* known = value.get(context, [] { return std::optional(2); });
            EXPECT_EQ(*known, 1);
          },
          Executor::Priority::fork_join);
      while (!asks) std::this_thread::yield();  // now it has the slot beside this one's, and soon waits
      Executor::TaskHandle helper = context.executor->submit([] {}, Executor::Priority::fork_join);
      while (!helper.done()) std::this_thread::yield();
      return std::optional(1);
    });
    EXPECT_EQ(*mine, 1);
    other.wait();
  }
}

}  // namespace
}  // namespace dismantle
