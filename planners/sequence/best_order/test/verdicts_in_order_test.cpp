// The sum of verdicts is that of one thread, in whatever order they are found.
#include "best_order/verdicts_in_order.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace dismantle::order {
namespace {

struct Answer {
  double cost = 0;
  bool refused = false, throws = false;
  int yields = 0;  // before the answer, so that other threads overtake
};

ObjectiveVerdict verdict_of(const Answer& answer, std::size_t k) {
  for (int i = 0; i < answer.yields; ++i) std::this_thread::yield();
  if (answer.throws) throw std::runtime_error(std::to_string(k));
  ObjectiveVerdict verdict;
  verdict.cost = answer.cost;
  if (answer.refused) verdict.refused = 0;
  return verdict;
}

/// As a text: the sum, or what was thrown.
std::string one_after_the_other(const std::vector<Answer>& answers, double most, double times) {
  double sum = 0;
  for (std::size_t k = 0; k < answers.size(); ++k) {
    if (answers[k].throws) return "threw " + std::to_string(k);
    if (answers[k].refused) return std::to_string(kForbidden);
    sum += times * answers[k].cost;
    if (sum > most) break;
  }
  return std::to_string(sum);
}

TEST(VerdictsInOrder, TheSumIsThatOfOneThread) {
  Rng rng(5);
  RunContext context;
  context.threads = 4;
  context.executor = std::make_shared<Executor>(4);
  int decided = 0, summed = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Answer> answers(rng.below(30));
    for (Answer& a : answers) {
      a.cost = rng.uniform();
      a.refused = rng.below(40) == 0;
      a.throws = rng.below(40) == 0;
      a.yields = static_cast<int>(rng.below(60));
    }
    const double most = rng.below(2) == 0 ? kForbidden : rng.uniform(0, 15),
                 times = 1 + static_cast<double>(rng.below(3));
    VerdictsInOrder verdicts(answers.size(), most, times);
    verdicts.find(context, [&](std::size_t k) { return verdict_of(answers[k], k); });
    std::string found;
    try {
      found = std::to_string(verdicts.sum());
    } catch (const std::runtime_error& e) {
      found = std::string("threw ") + e.what();
    }
    EXPECT_EQ(found, one_after_the_other(answers, most, times)) << trial;
    ++(verdicts.decided() ? decided : summed);
    if (verdicts.decided()) continue;
    for (std::size_t k = 0; k < answers.size(); ++k) EXPECT_EQ(verdicts[k].cost, answers[k].cost) << trial;
  }
  EXPECT_GT(decided, 50);
  EXPECT_GT(summed, 50);
}

}  // namespace
}  // namespace dismantle::order
