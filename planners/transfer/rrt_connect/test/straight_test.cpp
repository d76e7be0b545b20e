// Transfers without a search have the right ends, move the group as one body, and keep clear of other parts.
#include "../straight.h"

#include <gtest/gtest.h>

#include "dismantle/geometry/swept_boxes.h"
#include "dismantle/testing/fake_planning.h"
#include "dismantle/testing/path_checking.h"

namespace dismantle::rrt_connect {
namespace {

using Eigen::Vector3d;

constexpr double kClearance = 0.25;
constexpr double kRounding = 1e-9;

/// Two blocks that are to be moved as one body, and some that lie around; start and goal anywhere.
struct Errand {
  Assembly assembly;
  fake::Physics simulator;
  RunContext context;
  std::shared_ptr<const PreparedAssembly> prepared;
  Scene scene;
  std::vector<Pose> goal;
  Pose displacement;
  Vector3d up;
  fake::RuleChecker checker = fake::accept_all();
  TransferQuery query;

  static Assembly blocks(Rng& rng) {
    std::vector<std::pair<std::string, std::vector<fake::Box>>> parts;
    for (int i = 0; i < 6; ++i) {
      const Vector3d size(rng.uniform(0.2, 2), rng.uniform(0.2, 2), rng.uniform(0.2, 2));
      parts.push_back({"block_" + std::to_string(i), {{-0.5 * size, 0.5 * size}}});
    }
    return fake::assembly_of(parts);
  }
  static Pose random_pose(Rng& rng) {
    return {Vector3d(rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-9, 9)),
            rotation_from_vector(2 * Vector3d(rng.normal(), rng.normal(), rng.normal()))};
  }

  Errand(Rng& rng, bool turns)
      : assembly(blocks(rng)),
        prepared(simulator.prepare(assembly, 0.01, context)),
        displacement(random_pose(rng)),
        up(Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized()),
        query{assembly, simulator, *prepared, scene, goal, up, {}, 0.01, checker} {
    if (!turns) displacement.q.setIdentity();
    for (PartId id = 0; id < 6; ++id) (id < 2 ? scene.moving : scene.fixed).push_back({id, random_pose(rng)});
    for (const PlacedPart& p : scene.moving) goal.push_back(displacement * p.pose);
    query.scene = scene;
    query.goal = goal;
  }
  double reach(const std::vector<PlacedPart>& parts, const Vector3d& v, double sign) const {
    double most = -1e300;
    for (const PlacedPart& p : parts)
      for (const Vector3d& x : assembly.parts[p.part].mesh->vertices) most = std::max(most, sign * v.dot(p.pose * x));
    return sign * most;
  }
};

TEST(StraightTransfers, BeginAtTheStartEndAtTheGoalAndMoveTheGroupAsOneBody) {
  Rng rng(21);
  for (int trial = 0; trial < 60; ++trial) {
    const Errand errand(rng, trial % 2 == 0);
    PartBoxes boxes;
    const StraightTransfers straight(errand.query, kClearance, boxes);
    std::size_t found = 0;
    while (const auto path = straight.path(found)) {
      ++found;
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_LT((path->front()[i].t - errand.scene.moving[i].pose.t).norm(), kRounding);
        EXPECT_EQ(path->back()[i].t, errand.goal[i].t) << "to the last bit";
      }
      const Pose between = errand.scene.moving[0].pose.inverse() * errand.scene.moving[1].pose;
      for (const auto& row : *path) EXPECT_LT(((row[0].inverse() * row[1]).t - between.t).norm(), 1e-6);
    }
    EXPECT_EQ(found, 7U);
  }
}

/// Law: the first candidate lifts the group until it is `kClearance` above all other parts, and rotates and carries it
/// at no lower height.
TEST(StraightTransfers, FirstOverEverythingOnTheUpperSide) {
  Rng rng(22);
  for (int trial = 0; trial < 100; ++trial) {
    const Errand errand(rng, trial % 2 == 0);
    PartBoxes boxes;
    const auto path = StraightTransfers(errand.query, kClearance, boxes).path(0);
    ASSERT_TRUE(path);
    ASSERT_EQ(path->size(), 5U);
    const double top = errand.reach(errand.scene.fixed, errand.up, 1);
    for (std::size_t k = 1; k < 4; ++k) {
      std::vector<PlacedPart> there = errand.scene.moving;
      for (std::size_t i = 0; i < there.size(); ++i) there[i].pose = (*path)[k][i];
      EXPECT_GE(errand.reach(there, errand.up, -1), top + kClearance - 1e-6) << "trial " << trial << ", pose " << k;
    }
    // Up, turn, across, down: only the second of these turns.
    EXPECT_LT(angle_between((*path)[0][0].q, (*path)[1][0].q), 1e-7);
    EXPECT_LT(angle_between((*path)[2][0].q, (*path)[4][0].q), 1e-7);
    EXPECT_LT(((*path)[1][0].t - (*path)[0][0].t).cross(errand.up).norm(), 1e-6);
    EXPECT_LT(((*path)[4][0].t - (*path)[3][0].t).cross(errand.up).norm(), 1e-6);
  }
}

TEST(StraightTransfers, WithNothingAroundGoFromPlaceToPlace) {
  Rng rng(23);
  Errand errand(rng, true);
  errand.query.scene.fixed.clear();
  PartBoxes boxes;
  const StraightTransfers straight(errand.query, kClearance, boxes);
  ASSERT_TRUE(straight.path(0));
  EXPECT_EQ(straight.path(0)->size(), 3U);
  EXPECT_FALSE(straight.path(1));
}

TEST(StraightTransfers, AGroupThatWouldChangeItsShapeHasNone) {
  Rng rng(24);
  Errand errand(rng, true);
  errand.query.goal[1].t += Vector3d(0.1, 0, 0);
  PartBoxes boxes;
  EXPECT_FALSE(StraightTransfers(errand.query, kClearance, boxes).path(0));
}

}  // namespace
}  // namespace dismantle::rrt_connect
