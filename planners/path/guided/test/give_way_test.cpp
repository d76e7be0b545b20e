// What makes way leaves its place, and goes on afterwards.
#include "give_way.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "dismantle/testing/path_checking.h"

namespace dismantle::guided {
namespace {

TEST(GiveWay, ItsPlaceIsForThoseWhoHelpTheJudge) {
  Crew crew(2);
  GiveWay give_way(crew);
  std::atomic<bool> over{false};
  std::atomic<int> rounds{0};
  Crew::Offer beside = crew.offer(
      [&] {
        while (!over) {
          give_way.wait();
          ++rounds;
        }
      },
      Crew::Rank::part);
  while (rounds == 0) std::this_thread::yield();
  const fake::RuleChecker checker([&](const Path&) {
    Crew::Offer helper = crew.offer([] {}, Crew::Rank::part);
    while (!helper.done()) std::this_thread::yield();  // there is a place for it
    const int before = rounds;
    for (int k = 0; k < 1000; ++k) std::this_thread::yield();
    EXPECT_EQ(rounds, before) << "it waits";
    return fake::Ruling{};
  });
  for (int k = 0; k < 20; ++k) {
    give_way.judged(checker, {});
    const int before = rounds;
    while (rounds == before) std::this_thread::yield();  // it goes on
  }
  const fake::RuleChecker broken([](const Path&) -> fake::Ruling { throw std::runtime_error("no"); });
  EXPECT_THROW(give_way.judged(broken, {}), std::runtime_error);
  const int before = rounds;
  while (rounds == before) std::this_thread::yield();
  over = true;
  beside.wait();
}

}  // namespace
}  // namespace dismantle::guided
