#include "dismantle/speculative_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace dismantle {
namespace {

using Cache = SpeculativeCache<int, long>;
using Sequence = Cache::Sequence;
constexpr auto kPriority = Executor::Priority::speculative;

long square(int key) { return static_cast<long>(key) * key; }

Cache::Request request_of(int key) {
  return {key, [key](const RunContext&) { return square(key); }};
}

std::shared_ptr<Executor> executor_with(unsigned threads) {
  return threads > 0 ? std::make_shared<Executor>(threads) : nullptr;
}

/// Whatever was prefetched, replaced, cancelled or asked for before.
TEST(SpeculativeCache, GivesTheSameValuesOnAnyNumberOfThreads) {
  Rng rng(4);
  for (const unsigned threads : {0U, 1U, 2U, 4U})
    for (int trial = 0; trial < 20; ++trial) {
      Cache cache(executor_with(threads), kPriority, [](long value) { return value % 3 == 0; });
      EXPECT_EQ(cache.computes_ahead(), threads > 1);
      for (int round = 0; round < 20; ++round) {
        std::deque<Sequence> wanted(rng.below(5));
        for (auto& sequence : wanted)
          for (std::uint64_t k = rng.below(5); k-- > 0;)
            sequence.push_back(request_of(static_cast<int>(rng.below(30))));
        if (rng.uniform() < 0.7) cache.prefetch(std::move(wanted), {});
        for (std::uint64_t k = rng.below(6); k-- > 0;) {
          const int key = static_cast<int>(rng.below(30));
          ASSERT_EQ(cache.get(key, request_of(key).compute, {}), square(key));
          EXPECT_TRUE(cache.is_computed(key));
        }
      }
    }
}

TEST(SpeculativeCache, ComputesAheadWhatIsWantedAndEachValueOnce) {
  for (const unsigned threads : {2U, 3U}) {
    std::atomic<int> computed{0};
    const auto counting = [&](int key) {
      return Cache::Request{key, [&computed, key](const RunContext&) { return ++computed, square(key); }};
    };
    Cache cache(executor_with(threads), kPriority);
    std::deque<Sequence> wanted;
    for (int key = 0; key < 20; ++key) wanted.push_back({counting(key), counting(key % 7)});
    cache.prefetch(wanted, {});
    while (cache.unused() < 20) std::this_thread::yield();
    cache.prefetch(wanted, {});
    for (int key = 0; key < 20; ++key)
      EXPECT_EQ(cache.get(key, [](const RunContext&) -> long { throw std::logic_error("it is there"); }, {}),
                square(key));
    EXPECT_EQ(computed, 20);
    EXPECT_EQ(cache.unused(), 0u);
  }
}

/// In a sequence, nothing is computed after a value that ends it, or before the preceding values are known.
TEST(SpeculativeCache, SequencesAreComputedInOrderUntilTheirEnd) {
  Rng rng(7);
  for (int trial = 0; trial < 50; ++trial) {
    constexpr int kLength = 8;
    const int end = static_cast<int>(rng.below(kLength)), asked = static_cast<int>(rng.below(kLength));
    std::mutex mutex;
    std::vector<int> order;
    Cache cache(executor_with(3), kPriority, [end](long value) { return value == square(end); });
    Sequence sequence;
    for (int key = 0; key < kLength; ++key)
      sequence.push_back({key, [&, key](const RunContext&) {
                            const std::scoped_lock lock(mutex);
                            order.push_back(key);
                            return square(key);
                          }});
    const Cache::Compute own = sequence[static_cast<std::size_t>(asked)].compute;
    cache.prefetch({sequence}, {});
    EXPECT_EQ(cache.get(asked, own, {}), square(asked));
    while (cache.waiting() > 0) std::this_thread::yield();
    EXPECT_EQ(std::set(order.begin(), order.end()).size(), order.size()) << "each once";
    std::erase(order, asked);
    std::vector<int> expected;
    for (int key = 0; key <= end; ++key)
      if (key != asked) expected.push_back(key);
    EXPECT_EQ(order, expected);
  }
}

/// Computations that end only when cancelled.
Cache::Request endless(int key, std::atomic<int>& begun) {
  return {key, [&begun](const RunContext& context) -> long {
            ++begun;
            while (!context.should_stop()) std::this_thread::yield();
            return -1;
          }};
}

TEST(SpeculativeCache, WhatIsNoLongerWantedIsCancelledAndForgotten) {
  std::atomic<int> begun{0};
  Cache cache(executor_with(2), kPriority);
  for (int round = 1; round <= 20; ++round) {
    cache.prefetch({{endless(1, begun)}, {endless(2, begun)}}, {});
    while (begun < round) std::this_thread::yield();
    EXPECT_TRUE(cache.is_running(1));
    cache.prefetch({}, {});
    while (cache.is_running(1)) std::this_thread::yield();
    EXPECT_FALSE(cache.is_computed(1));
    EXPECT_EQ(begun, round) << "the other one was not begun";
  }
  EXPECT_EQ(cache.get(1, request_of(1).compute, {}), 1);
  EXPECT_EQ(cache.unused(), 0u);
}

/// Cancelled, and asked for before it has ended: then it is computed again.
TEST(SpeculativeCache, AnInterruptedValueIsNotAnAnswer) {
  std::atomic<int> begun{0};
  Cache cache(executor_with(2), kPriority);
  for (int key = 0; key < 50; ++key) {
    cache.prefetch({{endless(key, begun)}}, {});
    while (begun <= key) std::this_thread::yield();
    cache.prefetch({}, {});
    EXPECT_EQ(cache.get(key, request_of(key).compute, {}), square(key));
  }
}

TEST(SpeculativeCache, WhatIsAskedForIsNotCancelledByAPrefetch) {
  for (int trial = 0; trial < 50; ++trial) {
    const auto executor = executor_with(2);
    std::atomic<bool> replaced{false};
    std::atomic<int> begun{0};
    Cache cache(executor, kPriority);
    const Cache::Request slow{1, [&](const RunContext& context) -> long {
                                ++begun;
                                while (!replaced && !context.should_stop()) std::this_thread::yield();
                                return context.should_stop() ? -1 : 10;
                              }};
    cache.prefetch({{slow}}, {});
    while (begun == 0) std::this_thread::yield();
    // There is a slot for this task only when the asker waits.
    Executor::TaskHandle replace = executor->submit(
        [&] {
          cache.prefetch({}, {});
          replaced = true;
        },
        Executor::Priority::idle);
    EXPECT_EQ(cache.get(1, slow.compute, {}), 10);
    EXPECT_EQ(begun, 1);
  }
}

TEST(SpeculativeCache, TheAskerIsToldWhatItsOwnStopInterrupted) {
  for (const bool ahead : {false, true}) {
    std::atomic<int> begun{0};
    Cache cache(executor_with(2), kPriority);
    const Cache::Request request = endless(1, begun);
    if (ahead) {
      cache.prefetch({{request}}, {});
      while (begun == 0) std::this_thread::yield();
    }
    RunContext context;
    context.cancel.cancel();
    EXPECT_EQ(cache.get(1, request.compute, context), -1);
    EXPECT_EQ(cache.get(1, request_of(1).compute, {}), 1) << "it was not kept";
  }
}

TEST(SpeculativeCache, WhatAComputationThrowsIsThrownToTheAskerAlone) {
  for (const unsigned threads : {1U, 2U, 3U}) {
    std::atomic<int> tried{0};
    Cache cache(executor_with(threads), kPriority);
    const Cache::Request fails{1, [&](const RunContext&) -> long {
                                 ++tried;
                                 throw std::runtime_error("no");
                               }};
    cache.prefetch({{fails, request_of(2)}, {request_of(3)}}, {});
    while (cache.waiting() > 0) std::this_thread::yield();
    EXPECT_EQ(tried, threads > 1 ? 1 : 0) << "it is not tried again";
    EXPECT_THROW(cache.get(1, fails.compute, {}), std::runtime_error);
    EXPECT_EQ(cache.get(1, request_of(1).compute, {}), 1);
    EXPECT_FALSE(cache.is_computed(2)) << "its sequence ended";
    EXPECT_EQ(cache.is_computed(3), threads > 1);
  }
}

TEST(SpeculativeCache, NothingIsBegunAfterTheDeadline) {
  std::atomic<int> begun{0};
  Cache cache(executor_with(2), kPriority);
  RunContext late;
  late.deadline = Deadline::after_seconds(0);
  cache.prefetch({{endless(1, begun)}, {endless(2, begun)}}, late);
  while (cache.waiting() > 0) std::this_thread::yield();
  EXPECT_EQ(begun, 0);
}

/// Each on a thread of its own and one for the asker: never more computations than threads.
TEST(SpeculativeCache, NoMoreIsComputedThanThereAreThreads) {
  for (const unsigned threads : {2U, 3U}) {
    std::atomic<int> now{0}, most{0};
    const auto busy = [&](int key) {
      return Cache::Request{key, [&, key](const RunContext&) {
                              const int n = ++now;
                              for (int seen = most; n > seen && !most.compare_exchange_weak(seen, n);) {
                              }
                              for (int k = 0; k < 5; ++k) std::this_thread::yield();
                              --now;
                              return square(key);
                            }};
    };
    Cache cache(executor_with(threads), Executor::Priority::idle);
    std::deque<Sequence> wanted;
    for (int key = 0; key < 40; ++key) wanted.push_back({busy(key)});
    cache.prefetch(wanted, {});
    for (int key = 0; key < 40; ++key) EXPECT_EQ(cache.get(key, busy(key).compute, {}), square(key));
    EXPECT_LE(most, static_cast<int>(threads));
  }
}

TEST(SpeculativeCache, EndsWhileThreadsWork) {
  const auto executor = executor_with(3);
  for (int trial = 0; trial < 100; ++trial) {
    std::atomic<int> begun{0};
    Cache cache(executor, kPriority);
    cache.prefetch({{endless(1, begun)}, {request_of(2), endless(3, begun)}, {request_of(4)}}, {});
    if (trial % 2 == 0)
      while (begun == 0) std::this_thread::yield();
  }
}

}  // namespace
}  // namespace dismantle
