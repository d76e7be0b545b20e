// The bound of the cost that the plan states, where a check gives estimates.
#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "lattice_orders.h"

namespace dismantle {
namespace {

using lattice::AllOrders;
using lattice::Lattice;
using lattice::plan_of;
using lattice::priced;
using lattice::Prices;

/// What is there, judged; a search is told that it costs much where it costs little.
class Crowd final : public StepCheck {
 public:
  explicit Crowd(const Prices& prices) : prices_(prices) {}
  StepCheckTraits traits() const noexcept override { return {.reads_path = false, .estimates = true}; }
  StepVerdict judge(const StepQuestion& q, const RunContext&) const override {
    StepVerdict verdict;
    verdict.cost = q.moving.front().part % 2 == 0 ? prices_.present * static_cast<double>(q.present.size()) : 0;
    return verdict;
  }
  StepVerdict estimate(const StepQuestion& q, const RunContext&) const override {
    StepVerdict verdict;
    verdict.cost = 10 * prices_.present * static_cast<double>(9 - q.present.size());
    return verdict;
  }

 private:
  Prices prices_;
};

TEST(BestOrder, TheLeastCostHoldsWhateverAnEstimateSays) {
  Rng rng(59);
  unsigned compared = 0, something = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const Lattice lattice = Lattice::random(rng);
    Prices prices;
    for (double& price : prices.direction) price = 0.25 * static_cast<double>(rng.below(4));
    const Prices alone = prices;
    prices.present = 0.001;  // so little that the bound is nearly what the cheapest order costs
    const double truth = AllOrders(lattice, prices).cheapest((1U << lattice.parts) - 1, std::nullopt);
    if (!(truth < std::numeric_limits<double>::infinity())) continue;
    ++compared;
    Objective objective = priced(alone);
    objective.items.push_back({"crowd", std::make_shared<Crowd>(prices), 1, false});
    for (const double effort : {1e5, 60.0}) {
      const RunResult found = plan_of(lattice.assembly(), objective, std::make_shared<fake::InTurn>(), effort);
      EXPECT_GE(found.plan.objective.cost, truth - 1e-9) << trial;
      const double least = found.plan.objective.least_cost.value_or(0);
      EXPECT_LE(least, truth + 1e-9) << trial << " with effort " << effort;
      something += least > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 8u);
  EXPECT_GT(something, 5u);
}

}  // namespace
}  // namespace dismantle
