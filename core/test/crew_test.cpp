#include "dismantle/crew.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "dismantle/run_context.h"

namespace dismantle {
namespace {

using Rank = Crew::Rank;

TEST(Crew, WhatIsOfferedIsDoneOnceOrWithdrawn) {
  Rng rng(5);
  for (const unsigned threads : {1U, 2U, 4U}) {
    Crew crew(threads);
    for (int trial = 0; trial < 200; ++trial) {
      std::atomic<int> done{0};
      std::vector<Crew::Offer> offers;
      for (int k = 0; k < 6; ++k)
        offers.push_back(crew.offer([&] { ++done; }, rng.uniform() < 0.5 ? Rank::part : Rank::ahead));
      int withdrawn = 0;
      for (auto& offer : offers)
        if (rng.uniform() < 0.5 && offer.withdraw()) {
          ++withdrawn;
          EXPECT_TRUE(offer.withdraw()) << "it stays so";
        } else if (threads > 1) {
          offer.wait();
          EXPECT_FALSE(offer.withdraw());
        }
      offers.clear();
      EXPECT_LE(done, 6 - withdrawn);
      EXPECT_EQ(done, threads > 1 ? 6 - withdrawn : 0) << "with one thread there is nobody";
    }
  }
}

/// Those of the crew and others that enter if they can.
TEST(Crew, NoMoreAreAtWorkThanThereArePlaces) {
  for (const unsigned threads : {2U, 3U}) {
    Crew crew(threads);
    std::atomic<unsigned> working{1}, most{1};
    const auto work = [&] {
      const unsigned now = ++working;
      for (unsigned m = most; m < now && !most.compare_exchange_weak(m, now);) {
      }
      for (int k = 0; k < 10; ++k) std::this_thread::yield();
      --working;
    };
    std::atomic<bool> stop{false};
    std::jthread other([&] {
      while (!stop)
        if (crew.try_enter()) {
          work();
          crew.leave();
        }
    });
    std::vector<Crew::Offer> offers;
    for (int k = 0; k < 20; ++k) offers.push_back(crew.offer(work, Rank::ahead));
    while (!offers.back().done()) std::this_thread::yield();
    stop = true;
    other.join();
    EXPECT_LE(most, threads);
    EXPECT_GT(most, 1u);
  }
}

TEST(Crew, PartsComeBeforeWhatMayBeNeeded) {
  Crew crew(2);
  std::latch busy(1);
  Crew::Offer first = crew.offer([&] { busy.wait(); }, Rank::part);
  while (!first.running()) std::this_thread::yield();
  std::vector<int> order;
  std::vector<Crew::Offer> offers;
  for (int k = 0; k < 6; ++k)
    offers.push_back(crew.offer([&order, k] { order.push_back(k); }, k % 2 == 0 ? Rank::ahead : Rank::part));
  busy.count_down();
  for (auto& offer : offers)  // waiting would make place for another
    while (!offer.done()) std::this_thread::yield();
  EXPECT_EQ(order, (std::vector<int>{1, 3, 5, 0, 2, 4}));
}

TEST(Crew, WhoWaitsGivesUpItsPlaceMeanwhile) {
  Crew crew(2);
  std::atomic<int> met{0};
  const auto meet = [&] {  // ends when both are at work
    ++met;
    while (met < 2) std::this_thread::yield();
  };
  Crew::Offer one = crew.offer(meet, Rank::part);
  while (!one.running()) std::this_thread::yield();
  EXPECT_FALSE(crew.try_enter());
  crew.leave();
  EXPECT_TRUE(crew.try_enter());
  crew.leave();
  crew.enter();
  std::jthread other([&] {
    while (!crew.try_enter()) std::this_thread::yield();
    meet();
    crew.leave();
  });
  one.wait();
  EXPECT_EQ(met, 2);
}

TEST(Crew, WhatIsThrownIsThrownToWhoWaits) {
  Crew crew(2);
  Crew::Offer offer = crew.offer([] { throw std::runtime_error("no"); }, Rank::part);
  EXPECT_THROW(offer.wait(), std::runtime_error);
  {
    const Crew::Offer nobody_waits = crew.offer([] { throw std::runtime_error("no"); }, Rank::part);
  }
  Crew::Offer next = crew.offer([] {}, Rank::part);
  EXPECT_NO_THROW(next.wait());
}

TEST(Crew, TellsWhenThereIsAPlaceAndNoOffer) {
  Crew crew(2);
  std::atomic<int> told{0};
  crew.when_idle([&] { ++told; });
  crew.enter();
  crew.leave();
  EXPECT_GE(told, 1);
  const int before = told;
  Crew::Offer offer = crew.offer([] {}, Rank::part);
  offer.wait();
  while (told == before) std::this_thread::yield();
  crew.when_idle(nullptr);
  const int at_last = told;
  crew.enter();
  crew.leave();
  EXPECT_EQ(told, at_last);
}

/// Who waits gets the place of the thread that he waited for: there are never more at work than places, though others
/// stand ready to take what becomes free.
TEST(Crew, HandsItsPlaceToWhoWaits) {
  Crew crew(2);
  std::atomic<int> working{1}, most{1};
  const auto enter = [&] {
    const int now = ++working;
    for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
    }
  };
  for (int round = 0; round < 300; ++round) {
    std::atomic<bool> begun{false};
    std::vector<Crew::Offer> ahead;
    Crew::Offer part = crew.offer(
        [&] {
          enter();
          begun = true;
          for (int k = 0; k < 50; ++k) std::this_thread::yield();
          --working;
        },
        Rank::part);
    while (!begun) std::this_thread::yield();
    for (int k = 0; k < 2; ++k)
      ahead.push_back(crew.offer(
          [&] {
            enter();
            for (int n = 0; n < 200; ++n) std::this_thread::yield();
            --working;
          },
          Rank::ahead));
    --working;
    part.wait();
    enter();
  }
  EXPECT_LE(most, 2);
}

/// A place is left while something is offered, and that is withdrawn before anybody has taken it: others are told.
TEST(Crew, TellsOfAPlaceWhenAnOfferIsWithdrawn) {
  for (int trial = 0; trial < 200; ++trial) {
    Crew crew(2);
    std::atomic<int> told{0};
    crew.enter();  // both places are taken
    std::atomic<bool> done{false};
    Crew::Offer offer = crew.offer([&] { done = true; }, Rank::part);
    crew.when_idle([&] { ++told; });
    crew.leave();
    if (!offer.withdraw()) offer.wait();
    while (told == 0) std::this_thread::yield();
    crew.when_idle(nullptr);
    EXPECT_GE(told, 1);
  }
}

TEST(Crew, OffersMayOutliveIt) {
  Crew::Offer offer;
  {
    Crew crew(1);
    offer = crew.offer([] { FAIL() << "there was nobody"; }, Rank::part);
  }
  EXPECT_TRUE(offer.withdraw());
}

}  // namespace
}  // namespace dismantle
