// Which groups are thinner than their overlap.
#include "thin_groups.h"

#include <gtest/gtest.h>

#include "table.h"

namespace dismantle::portfolio {
namespace {

using path::test::assembly_of;
using path::test::block;
using path::test::boxes;
using path::test::Table;

TEST(ThinGroups, RadiiAreThoseOfBallsInside) {
  const Mesh slab = boxes({block(0, 0, 0, 4, 3, 0.4)});
  const std::vector<double> radii = inner_radii(slab, 16);
  ASSERT_EQ(radii.size(), 16U);
  for (const double r : radii) {
    EXPECT_GT(r, 0);
    EXPECT_LE(r, 0.2 + 1e-6);
  }
}

/// The limit is a quarter of the thickness where balls fit well, and less near the edges.
TEST(ThinGroups, AreThoseThatOverlapByALargePartOfTheirThickness) {
  const double thickness = 0.4;
  for (const double share : {0.0, 0.05, 0.3, 0.5}) {
    Assembly assembly = assembly_of({boxes({block(0, 0, 0, 4, 3, thickness)}), boxes({block(-1, -1, -2, 5, 4, 0)})});
    assembly.overlaps = {{0, 1, share * thickness}};
    const Table table(assembly);
    const Scene scene{{{0, Pose{}}}, {{1, Pose{}}}};
    const Budget budget;
    const fake::RuleChecker checker([](const Path&) { return fake::Ruling{}; });
    const PathQuery query{assembly, *table.simulator, *table.prepared, scene, budget, 0.01, checker, {}, nullptr};
    EXPECT_EQ(thinner_than_overlap(query), share > 0.1) << share;
  }
}

}  // namespace
}  // namespace dismantle::portfolio
