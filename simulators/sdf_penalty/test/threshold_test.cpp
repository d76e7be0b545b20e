// Depth of every contact before it resists.
#include "scene.h"

namespace dismantle::sdf_penalty {
namespace {

using namespace test;

TEST(Threshold, AThresholdWiderThanAStepStillResists) {
  const TestScene scene(
      {box(Vector3d(-0.5, -0.5, 0), Vector3d(0.5, 0.5, 1)), box(Vector3d(-4, -4, -1), Vector3d(4, 4, 0))},
      with({{"contact_threshold", 0.01}, {"max_travel", 0.002}}));
  auto world = scene.world({0});
  EXPECT_NEAR(world->penetration(at(*world, shift(0, 0, -0.03))), 0.02, 1e-12);
  State s = world->initial_state();
  world->advance(s, push(Vector3d(0, 0, -100)), 0.2, nullptr);
  EXPECT_NEAR(displacement(*world, s).z(), -0.01, 1e-3);
}

TEST(Threshold, TheWidestThresholdIsGrantedInFull) {
  const TestScene scene(
      {box(Vector3d(-0.5, -0.5, 0), Vector3d(0.5, 0.5, 1)), box(Vector3d(-4, -4, -1), Vector3d(4, 4, 0))},
      with({{"contact_threshold", 0.1}}));
  auto world = scene.world({0});
  EXPECT_NEAR(world->penetration(at(*world, shift(0, 0, -0.12))), 0.02, 1e-12);
  State s = world->initial_state();
  world->advance(s, push(Vector3d(0, 0, -100)), 0.2, nullptr);
  EXPECT_NEAR(displacement(*world, s).z(), -0.1, 1e-3);
}

}  // namespace
}  // namespace dismantle::sdf_penalty
