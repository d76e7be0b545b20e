// Projection to clearance, as far as there is room.
#include <limits>

#include "world_scene.h"

namespace dismantle::sdf {
namespace {

using namespace test;

class Retreat : public testing::TestWithParam<std::string> {};

/// Least distance to any contact in range, negative inside.
double room(World& world, const State& state) {
  std::vector<Contact> contacts;
  world.contacts(state, contacts);
  double least = 1;
  for (const Contact& c : contacts) least = std::min(least, -c.depth);
  return least;
}

TEST_P(Retreat, ManyContactsDoNotPushIntoTheFewOnTheOtherSide) {
  Rng rng(11);
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    // A plate between a table and the tip of a nail, with less room than requested.
    const double gap = rng.uniform(0.006, 0.03), below = rng.uniform(0.1, 0.9) * gap;
    const double x = rng.uniform(0.3, 0.7), y = rng.uniform(0.3, 0.7), top = 0.2 + gap - below;
    const TestScene scene(
        GetParam(),
        {box(Vector3d(0, 0, 0), Vector3d(1, 1, 0.2)), box(Vector3d(-1, -1, -1 - below), Vector3d(2, 2, -below)),
         box(Vector3d(x, y, top), Vector3d(x + 0.02, y + 0.02, top + 1))},
        {});
    auto world = scene.world({0}, MotionSpace::rigid);
    State s = world->initial_state();
    const double before = room(*world, s);
    world->project_to_clearance(s, 0.02);
    EXPECT_EQ(world->penetration(s), 0);
    EXPECT_GE(room(*world, s), before - 1e-9);
    EXPECT_GE(room(*world, s), 0.15 * gap);
  }
}

TEST_P(Retreat, WithoutALimitItTakesTheMiddleOfTheRoom) {
  for (const double gap : {0.0005, 0.002, 0.01, 0.03}) {
    SCOPED_TRACE(gap);
    // A plate that lies on a table, under a ceiling.
    const TestScene scene(GetParam(),
                          {box(Vector3d(0, 0, 0), Vector3d(1, 1, 0.2)), box(Vector3d(-1, -1, -1), Vector3d(2, 2, 0)),
                           box(Vector3d(-1, -1, 0.2 + gap), Vector3d(2, 2, 1))},
                          {});
    auto world = scene.world({0}, MotionSpace::rigid);
    State s = world->initial_state();
    world->project_to_clearance(s, std::numeric_limits<double>::infinity());
    EXPECT_GE(room(*world, s), 0.25 * gap);
  }
}

INSTANTIATE_TEST_SUITE_P(Simulators, Retreat, testing::Values("sdf_penalty", "sdf_velocity"));

}  // namespace
}  // namespace dismantle::sdf
