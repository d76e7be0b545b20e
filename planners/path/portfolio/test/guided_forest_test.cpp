// A forest alternates with contact search within one budget.
#include <gtest/gtest.h>

#include "narrow_places.h"
#include "table.h"

namespace dismantle::portfolio {
namespace {

using path::test::assembly_of;
using path::test::linked_ring;
using path::test::open_ring;
using path::test::Table;

/// The preset without the other trees, because these sometimes solve the assembly as well.
ParamSet forest(std::int64_t after, std::int64_t steps) {
  std::vector<std::string> without{"tolerant_rrt"};
  if (steps == 0) without.emplace_back("tunnel_forest");
  return path::test::guided({{"turn", after}, {"tunnel_forest.after", after}, {"tunnel_forest.max_steps", steps}},
                            without);
}

TEST(GuidedForest, TakesOffARingThatContactSearchDoesNot) {
  Rng rng(21);
  for (std::uint64_t k = 1; k <= 2; ++k) {
    const Pose turned{Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()), tunnel_forest::random_turn(rng)};
    Table table(assembly_of({linked_ring(), open_ring(0.6)}, k == 1 ? Pose{} : turned));
    const PathResult alone = table.plan("guided", forest(2000, 0), k, 20'000);
    EXPECT_EQ(alone.outcome(), Outcome::timeout) << "contact search alone must not solve it";
    EXPECT_FALSE(alone.stats.extra.contains("tunnel_forest_steps"));
    const PathResult both = table.plan("guided", forest(2000, 1'000'000), k, 1'000'000);
    ASSERT_EQ(both.outcome(), Outcome::solved) << k;
    EXPECT_GT(both.stats.extra.at("tunnel_forest_steps"), 0);
    const PathResult again = table.plan("guided", forest(2000, 1'000'000), k, 1'000'000);
    ASSERT_EQ(again.path()->poses().size(), both.path()->poses().size());
    EXPECT_TRUE(again.path()->poses().back()[0].t == both.path()->poses().back()[0].t);
  }
}

TEST(GuidedForest, BothShareOneBudget) {
  for (const std::uint64_t steps : {500u, 3000u, 9000u}) {
    Table table(assembly_of({linked_ring(), open_ring(0.4)}));
    const PathResult r = table.plan("guided", forest(1000, 1'000'000), 1, steps);
    EXPECT_EQ(r.outcome(), Outcome::timeout);
    double used = r.stats.cost;  // state checks of the forest are not limited
    if (r.stats.extra.contains("tunnel_forest_state_checks")) used -= r.stats.extra.at("tunnel_forest_state_checks");
    EXPECT_GE(used, 0.9 * static_cast<double>(steps));
    // The end of a portion does not interrupt an extension of a forest.
    EXPECT_LE(used, static_cast<double>(steps) + 300);
  }
}

TEST(GuidedForest, UnderADepthLimitThereIsNone) {
  Table table(assembly_of({linked_ring(), open_ring(0.6)}));
  EXPECT_FALSE(table.plan("guided", forest(1, 1'000'000), 1, 20'000, 2).stats.extra.contains("tunnel_forest_steps"));
}

}  // namespace
}  // namespace dismantle::portfolio
