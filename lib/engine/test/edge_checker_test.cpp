// Path planners may ask the verifier about one edge of a tree.
#include "dismantle/geometry/edge_checker.h"

#include <gtest/gtest.h>

#include "dismantle/testing/oracle_rig.h"
#include "dismantle/testing/path_checking.h"
#include "dismantle/testing/run_rig.h"

namespace dismantle {
namespace {

using fake::leave;
using fake::outcome;
using fake::Rig;
using fake::row;

Pose at(double x, double y, double z) {
  Pose pose;
  pose.t = {x, y, z};
  return pose;
}

TEST(EdgeChecker, AnEdgeIsFreeWhereTheVerifierLetsItPassWhereverItBeginsAndEnds) {
  PathCheck away, elsewhere, through, alone;
  const auto search = [&](const PathQuery& query, RunContext&) {
    const geometry::EdgeChecker* edges = geometry::edge_checker(query.checker);
    EXPECT_NE(edges, nullptr);
    if (edges == nullptr) return outcome(Outcome::exhausted);
    away = edges->check_edge({at(0, 0, 0)}, {at(0, 0, 0.3)});
    elsewhere = edges->check_edge({at(0, 0, 20)}, {at(20, 0, 20)});
    through = edges->check_edge({at(-20, 0, 0)}, {at(20, 0, 0)});
    alone = edges->check_edge({}, {});
    return outcome(Outcome::exhausted);
  };
  Rig rig(row(2), fake::setup(search));
  rig.ask(leave(rig.assembly, 0, 1));
  EXPECT_TRUE(geometry::is_free(away)) << away.reason << ": it does not leave the part, and that is no matter";
  EXPECT_TRUE(geometry::is_free(elsewhere)) << elsewhere.reason << ": it does not begin where the part is";
  EXPECT_FALSE(geometry::is_free(through)) << "the other part stands in the middle of it";
  EXPECT_TRUE(through.has_witness);
  EXPECT_EQ(through.instant, 0u);
  EXPECT_FALSE(geometry::is_free(alone));
  for (const PathCheck* answer : {&away, &elsewhere, &through}) EXPECT_FALSE(answer->accepted());
}

TEST(EdgeChecker, ACheckerOfWholePathsIsNone) { EXPECT_EQ(geometry::edge_checker(fake::accept_all()), nullptr); }

}  // namespace
}  // namespace dismantle
