// Parts may keep their assembled overlap, but never pass through anything.
#include "world_scene.h"

namespace dismantle::sdf {
namespace {

using namespace test;

/// Part 0 is `overlap` deep in part 1 and flush on part 2.
TestScene overlapping(const std::string& simulator, double overlap, ParamSet given = {}) {
  return TestScene(simulator,
                   {box(Vector3d(0, 0, 0), Vector3d(1, 1, 1)), box(Vector3d(1 - overlap, -1, -0.5), Vector3d(2, 2, 1)),
                    box(Vector3d(-3, -3, -1), Vector3d(0.5, 3, 0))},
                   given, {{0, 1, overlap}});
}
class Overlap : public testing::TestWithParam<std::string> {};

constexpr double kSlack = 0.004;  // a pair that overlaps may be given a little more than it had
const double kOverlaps[] = {0.002, 0.008, 0.012, 0.03, 0.05, 0.2};

TEST_P(Overlap, IsAllowedToItsPairAndToNoOther) {
  for (const double overlap : kOverlaps)
    for (const double max_travel : {0.02, 0.004}) {
      SCOPED_TRACE(testing::Message() << overlap << ", steps of " << max_travel);
      const TestScene scene = overlapping(GetParam(), overlap, {{"max_travel", max_travel}});
      auto world = scene.world({0});
      for (const bool relaxed : {false, true}) {
        if (relaxed) world->allow_overlap_everywhere();
        EXPECT_LT(world->penetration(world->initial_state()), 1e-6);
        for (const double depth : {0.01, 0.02}) {
          EXPECT_NEAR(world->penetration(at(*world, shift(0, 0, -depth))), depth, 1e-9) << "part 2 is as hard as ever";
          const double into = world->penetration(at(*world, shift(depth, 0, 0)));
          EXPECT_LE(into, depth + 1e-9);
          EXPECT_GE(into, depth - kSlack);
        }
        State s = world->initial_state();
        world->advance(s, push(Vector3d(100, 0, 0)), 0.2, nullptr);
        EXPECT_LT(displacement(*world, s).x(), kSlack + 1e-3) << "no deeper than it was";
      }
    }
}

TEST_P(Overlap, HoldsNothingBackOnceRelaxed) {
  for (const double overlap : kOverlaps) {
    SCOPED_TRACE(overlap);
    const TestScene scene = overlapping(GetParam(), overlap);
    auto world = scene.world({0});
    world->allow_overlap_everywhere();
    EXPECT_FALSE(world->overlap_is_local()) << "nothing is left to relax";
    for (const Vector3d& way_out : {Vector3d(0, 1, 0), Vector3d(0, 0, 1), Vector3d(-1, 0, 0)}) {
      State s = world->initial_state();
      world->advance(s, push(100 * way_out), 0.2, nullptr);
      EXPECT_NEAR(displacement(*world, s).dot(way_out), 0.5, 1e-2) << way_out.transpose();
    }
  }
}

TEST_P(Overlap, IsNoWayThroughAWall) {
  // The part overlaps the foot of a wall by more than the wall is thick, and the wall still blocks.
  const TestScene scene(
      GetParam(),
      {box(Vector3d(0, 0, 0), Vector3d(1, 1, 1)),
       joined(box(Vector3d(0.96, -1, -1), Vector3d(3, 2, 0.2)), box(Vector3d(1.3, -3, -1), Vector3d(1.33, 4, 3)))},
      {}, {{0, 1, 0.04}});
  auto world = scene.world({0});
  State s = world->initial_state();
  world->advance(s, push(Vector3d(0, 0, 100)), 0.16, nullptr);
  ASSERT_NEAR(displacement(*world, s).z(), 0.4, 1e-2);
  world->advance(s, push(Vector3d(100, 0, 0)), 0.4, nullptr);
  EXPECT_LT(displacement(*world, s).x(), 0.3 + 0.012);
}

INSTANTIATE_TEST_SUITE_P(Simulators, Overlap, testing::Values("sdf_penalty", "sdf_velocity"));

}  // namespace
}  // namespace dismantle::sdf
