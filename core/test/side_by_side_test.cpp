// Two pieces of work at the same time, whoever does them.
#include "dismantle/side_by_side.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "dismantle/crew.h"

namespace dismantle {
namespace {

RunContext with(unsigned threads) {
  RunContext context;
  if (threads > 0) context.crew = std::make_shared<Crew>(threads);
  return context;
}

TEST(SideBySide, BothAreDoneOnceEachTime) {
  Rng rng(3);
  for (const unsigned threads : {0U, 1U, 2U, 3U}) {
    const RunContext context = with(threads);
    for (int trial = 0; trial < 20; ++trial) {
      SideBySide both(context);
      const int rounds = static_cast<int>(rng.below(50));
      int first = 0, second = 0;  // no atomics: each is done before the call returns
      for (int k = 0; k < rounds; ++k) {
        both([&] { ++first; }, [&] { ++second; });
        ASSERT_EQ(first, k + 1);
        ASSERT_EQ(second, k + 1);
        if (k % 10 == 0) std::this_thread::yield();
      }
    }
  }
}

TEST(SideBySide, AnIdleThreadDoesTheSecond) {
  const RunContext context = with(2);
  SideBySide both(context);
  std::thread::id first, second;
  do {
    both([&] { first = std::this_thread::get_id(); }, [&] { second = std::this_thread::get_id(); });
  } while (first == second);  // until it is there
  EXPECT_EQ(first, std::this_thread::get_id());
  both([&] { first = std::this_thread::get_id(); }, [&] { second = std::this_thread::get_id(); });
  EXPECT_NE(first, second) << "it stays";
}

TEST(SideBySide, WhatIsThrownIsThrownWhenBothAreDone) {
  for (const unsigned threads : {2U, 3U}) {
    const RunContext context = with(threads);
    SideBySide both(context);
    for (int k = 0; k < 50; ++k) {
      std::atomic<bool> done{false};
      EXPECT_THROW(both([&] { done = true; }, [] { throw std::runtime_error("no"); }), std::runtime_error);
      EXPECT_TRUE(done);
      EXPECT_THROW(both([] { throw std::runtime_error("no"); }, [] {}), std::runtime_error);
      EXPECT_NO_THROW(both([] {}, [] {}));
    }
  }
}

}  // namespace
}  // namespace dismantle
