// Wrenches as accelerations, and several time steps in one, against the fixed step.
#include <algorithm>
#include <cmath>

#include "dismantle/run_context.h"
#include "scene.h"

namespace dismantle::sdf_penalty {
namespace {

using namespace test;

ParamSet accelerations(ParamSet given = {}) { return dynamics("acceleration", std::move(given)); }

Vector3d random_vector(Rng& rng, double size) {
  const auto x = [&] { return rng.uniform(-size, size); };
  const double a = x(), b = x(), c = x();
  return {a, b, c};
}

/// Two cubes of different size, and a plate far away from both.
std::vector<Mesh> cubes() {
  return {box(Vector3d(0, 0, 0), Vector3d(0.5, 0.5, 0.5)), box(Vector3d(3, 0, 0), Vector3d(5, 2, 2)),
          box(Vector3d(-20, -20, -20), Vector3d(-19, -19, -19))};
}

TEST(TimeStep, AccelerationIsTheSameForEveryMassAndInertia) {
  const TestScene scene(cubes(), accelerations({{"max_travel", 0.1}}));
  Rng rng(1);
  for (int k = 0; k < 20; ++k) {
    const Vector3d force = random_vector(rng, 50), torque = random_vector(rng, 20);
    for (const PartId part : {0u, 1u}) {
      auto world = scene.world({part}, MotionSpace::rigid);
      State s = world->initial_state();
      world->advance(s, push(force, torque), 0.05, nullptr);
      const double sum = 1e-6 * 50 * 51 / 2;
      EXPECT_LT((displacement(*world, s) - sum * force).norm(), 1e-9);
      EXPECT_NEAR(angle_between(s.bodies[0].pose.q, Eigen::Quaterniond::Identity()), sum * torque.norm(), 1e-6);
      EXPECT_LT((s.bodies[0].angular_velocity - 0.05 * torque).norm(), 1e-6);
    }
  }
}

TEST(TimeStep, FreeFlightInFewStepsEndsWhereTheFixedStepEnds) {
  const TestScene fixed(cubes(), accelerations({{"max_travel", 0.1}}));
  const TestScene adaptive(cubes(), accelerations({{"max_travel", 0.1}, {"adaptive", true}}));
  Rng rng(2);
  for (int k = 0; k < 20; ++k) {
    const Vector3d force = random_vector(rng, 60), torque = random_vector(rng, 20);
    auto a = fixed.world({1}, MotionSpace::rigid), b = adaptive.world({1}, MotionSpace::rigid);
    State x = a->initial_state(), y = b->initial_state();
    const StepReport reference = a->advance(x, push(force, torque), 0.1, nullptr);
    const StepReport few = b->advance(y, push(force, torque), 0.1, nullptr);
    EXPECT_EQ(reference.steps, 100u);
    EXPECT_LT(few.steps, 20u);
    EXPECT_LT(apart(x, y), 1e-6);
    EXPECT_LT((x.bodies[0].velocity - y.bodies[0].velocity).norm(), 1e-9);
    EXPECT_LT((x.bodies[0].angular_velocity - y.bodies[0].angular_velocity).norm(), 1e-6);
  }
}

/// A block on a floor, with a force down and along the floor.
TEST(TimeStep, SlidingLeadsAsFarAsTheFixedStepToWithinASixth) {
  const std::vector<Mesh> parts{box(Vector3d(0, 0, 0), Vector3d(1, 1, 1)),
                                box(Vector3d(-5, -5, -1), Vector3d(5, 5, 0))};
  const TestScene fixed(parts, accelerations({{"max_travel", 0.06}}));
  const TestScene adaptive(parts, accelerations({{"max_travel", 0.06}, {"adaptive", true}}));
  Rng rng(3);
  for (int k = 0; k < 20; ++k) {
    const double angle = rng.uniform(0, 6.28);
    const Vector3d force = 60 * Vector3d(std::cos(angle), std::sin(angle), -1);
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      auto a = fixed.world({0}, space), b = adaptive.world({0}, space);
      State x = a->initial_state(), y = b->initial_state();
      const StepReport reference = a->advance(x, push(force), 0.1, nullptr);
      const StepReport few = b->advance(y, push(force), 0.1, nullptr);
      const double expected = 60 * 1e-6 * 100 * 101 / 2;
      EXPECT_NEAR(displacement(*a, x).head<2>().norm(), expected, 0.01 * expected);
      EXPECT_NEAR(displacement(*b, y).head<2>().norm(), displacement(*a, x).head<2>().norm(), expected / 6);
      EXPECT_LT((displacement(*a, x) - displacement(*b, y)).cross(Vector3d::UnitZ()).norm(), expected / 6)
          << "the same direction";
      EXPECT_GT(displacement(*b, y).z(), -2e-3);
      EXPECT_LT(few.steps, reference.steps / 4);
    }
  }
}

/// A cube in a closed room with clearance moves to the wall and stays there.
TEST(TimeStep, StuckPartsStayPutAndTheAdvanceEnds) {
  const double play = 0.02;
  const std::vector<Mesh> parts{box(Vector3d::Constant(-0.5 + play), Vector3d::Constant(0.5 - play)),
                                closed_room(Vector3d::Constant(0.5), 0.2)};
  const TestScene every(parts, accelerations({{"max_travel", 0.06}}));
  const TestScene early(parts, accelerations({{"max_travel", 0.06}, {"rest_share", 0.01}}));
  const TestScene adaptive(parts, accelerations({{"max_travel", 0.06}, {"adaptive", true}, {"rest_share", 0.01}}));
  Rng rng(4);
  for (int k = 0; k < 20; ++k) {
    const Vector3d force = 100 * random_vector(rng, 1).normalized();
    auto a = every.world({0}), b = early.world({0}), c = adaptive.world({0});
    State x = a->initial_state(), y = b->initial_state(), z = c->initial_state();
    EXPECT_EQ(a->advance(x, push(force), 0.1, nullptr).steps, 100u);
    const StepReport ended = b->advance(y, push(force), 0.1, nullptr);
    const StepReport few = c->advance(z, push(force), 0.1, nullptr);
    EXPECT_TRUE(ended.stalled);
    EXPECT_TRUE(few.stalled);
    EXPECT_LE(few.steps, ended.steps);
    // The rest of the motion is at most `rest_share` of 0.5.
    EXPECT_LT(apart(x, y), 0.006);
    EXPECT_LT(apart(x, z), 0.006);
    // A part that slides slowly along a wall continues to slide.
    a->advance(x, push(force), 0.1, nullptr);
    c->advance(z, push(force), 0.1, nullptr);
    EXPECT_LT(apart(x, z), 0.012);
  }
}

}  // namespace
}  // namespace dismantle::sdf_penalty
