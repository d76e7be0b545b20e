// Bodies that touch nothing: closed forms of the three dynamics.
#include <cmath>
#include <numbers>

#include "scene.h"

namespace dismantle::sdf_penalty {
namespace {

using namespace test;

const char* const kAllDynamics[] = {"quasi_static", "unit_mass", "density"};

/// A small box (volume 0.125), a large one (volume 6) and a plate far away from both.
std::vector<Mesh> apart_parts() {
  return {box(Vector3d(0, 0, 0), Vector3d(0.5, 0.5, 0.5)), box(Vector3d(3, 0, 0), Vector3d(4, 2, 3)),
          box(Vector3d(-20, -20, -20), Vector3d(-19, -19, -19))};
}

TEST(FreeMotion, UnitMassFollowsBackwardEuler) {
  const TestScene scene(apart_parts(), dynamics("unit_mass"));
  for (const PartId part : {0u, 1u}) {
    auto world = scene.world({part});
    State s = world->initial_state();
    const Vector3d force(30, -20, 50);
    const double h = 1e-3;
    for (int n = 1; n <= 3; ++n) {
      const StepReport report = world->advance(s, push(force), 0.05, nullptr);
      EXPECT_EQ(report.steps, 50u);
      EXPECT_TRUE(report.finite);
      EXPECT_FALSE(report.stalled);
      const double steps = 50.0 * n;
      EXPECT_LT((s.bodies[0].velocity - steps * h * force).norm(), 1e-10);
      EXPECT_LT((displacement(*world, s) - h * h * force * steps * (steps + 1) / 2).norm(), 1e-10);
    }
  }
}

TEST(FreeMotion, DensityDividesByTheMassOfThePart) {
  const TestScene scene(apart_parts(), dynamics("density", {{"density", 2.0}}));
  const double masses[] = {2.0 * 0.125, 2.0 * 6.0};
  double displacements[2];
  for (const PartId part : {0u, 1u}) {
    auto world = scene.world({part});
    State s = world->initial_state();
    world->advance(s, push(Vector3d(0, 0, 10)), 0.04, nullptr);
    displacements[part] = displacement(*world, s).z();
    EXPECT_NEAR(displacements[part], 1e-6 * 10 / masses[part] * 40 * 41 / 2, 1e-10);
  }
  EXPECT_NEAR(displacements[0] / displacements[1], 48, 1e-6) << "the heavier part is slower, as in the paper";
}

TEST(FreeMotion, QuasiStaticSpeedIsForceOverDragWhateverTheMass) {
  const TestScene scene(apart_parts(), dynamics("quasi_static", {{"drag", 25.0}}));
  for (const PartId part : {0u, 1u})
    for (const double size : {1.0, 100.0, 1e5}) {
      auto world = scene.world({part});
      State s = world->initial_state();
      const Vector3d force = size * Vector3d(0.6, 0, 0.8);
      const double duration = 1.0 / size;
      const StepReport report = world->advance(s, push(force), duration, nullptr);
      EXPECT_LT((displacement(*world, s) - duration / 25 * force).norm(), 1e-10);
      EXPECT_NEAR(report.travel, duration / 25 * size, 1e-10);
      EXPECT_EQ(s.bodies[0].velocity, Vector3d::Zero());
    }
}

TEST(FreeMotion, SpeedIsBoundByTheLargestTravelOfAStep) {
  const TestScene scene(apart_parts(), dynamics("unit_mass", {{"max_travel", 0.005}}));
  auto world = scene.world({0});
  State s = world->initial_state();
  Trace trace;
  world->advance(s, push(Vector3d(1e5, 0, 0)), 0.05, &trace);
  EXPECT_NEAR(displacement(*world, s).x(), 50 * 0.005, 1e-10);
  EXPECT_NEAR(s.bodies[0].velocity.x(), 5, 1e-9);
}

TEST(FreeMotion, WithoutForceQuasiStaticStaysAndInertiaGoesOn) {
  {
    const TestScene scene(apart_parts(), dynamics("quasi_static"));
    auto world = scene.world({0});
    State s = world->initial_state();
    const StepReport report = world->advance(s, push(Vector3d::Zero()), 0.1, nullptr);
    EXPECT_TRUE(report.stalled);
    EXPECT_EQ(apart(s, world->initial_state()), 0.0);
  }
  const TestScene scene(apart_parts(), dynamics("unit_mass"));
  auto world = scene.world({0});
  State s = world->initial_state();
  s.bodies[0].velocity = Vector3d(3, 0, -1);
  world->advance(s, push(Vector3d::Zero()), 0.1, nullptr);
  EXPECT_LT((displacement(*world, s) - Vector3d(0.3, 0, -0.1)).norm(), 1e-10);
}

TEST(FreeMotion, TwiceTheDurationIsTwoAdvances) {
  for (const char* name : kAllDynamics)
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      const TestScene scene(apart_parts(), dynamics(name));
      auto world = scene.world({0}, space);
      const Action action = push(Vector3d(5, 9, -7), Vector3d(0.2, 0.4, -0.3));
      State once = world->initial_state(), twice = once;
      world->advance(once, action, 0.08, nullptr);
      world->advance(twice, action, 0.04, nullptr);
      world->advance(twice, action, 0.04, nullptr);
      EXPECT_LT(apart(once, twice), space == MotionSpace::translation ? 1e-9 : 1e-5) << name;
      EXPECT_LT((once.bodies[0].velocity - twice.bodies[0].velocity).norm(), 1e-7) << name;
    }
}

TEST(FreeMotion, TheTraceEndsAtTheStateAndIsDense) {
  const std::vector<Vector3d> corners = apart_parts().front().vertices;
  for (const char* name : kAllDynamics) {
    const TestScene scene(apart_parts(), dynamics(name));
    auto world = scene.world({0}, MotionSpace::rigid);
    State s = world->initial_state();
    Trace trace{{shift(9, 9, 9)}};
    const StepReport report = world->advance(s, push(Vector3d(40, 0, 0), Vector3d(0, 3, 0)), 0.1, &trace);
    ASSERT_EQ(trace.size(), report.steps + 1) << "appended, begin excluded";
    EXPECT_EQ(trace.front()[0].t, Vector3d(9, 9, 9));
    EXPECT_EQ(trace.back()[0].t, s.bodies[0].pose.t);
    EXPECT_EQ(trace.back()[0].q.coeffs(), s.bodies[0].pose.q.coeffs());
    trace.front()[0] = Pose{};
    for (std::size_t k = 1; k < trace.size(); ++k)
      for (const Vector3d& corner : corners)
        ASSERT_LE((trace[k][0] * corner - trace[k - 1][0] * corner).norm(), 0.02 * 1.001) << name;  // max_travel
  }
}

TEST(FreeMotion, TorqueTurnsABodyAboutItsCentre) {
  const TestScene scene(apart_parts(), dynamics("quasi_static"));
  for (const PartId part : {0u, 1u})
    for (int axis = 0; axis < 3; ++axis) {
      auto world = scene.world({part}, MotionSpace::rigid);
      State s = world->initial_state();
      const double r = world->radius(0), torque = 100 * r, duration = 0.3;
      world->advance(s, push(Vector3d::Zero(), torque * Vector3d::Unit(axis)), duration, nullptr);
      const double angle = duration * torque / (40 * r * r);
      ASSERT_LT(angle, std::numbers::pi);
      EXPECT_LT((rotation_vector(s.bodies[0].pose.q) - angle * Vector3d::Unit(axis)).norm(), 1e-9);
      EXPECT_LT(displacement(*world, s).norm(), 1e-9) << "the centre stays";
      EXPECT_NEAR(s.bodies[0].pose.q.norm(), 1, 1e-12);
    }
}

TEST(FreeMotion, RadiusAndCentreAreThoseOfTheBox) {
  const TestScene scene(apart_parts(), {});
  auto world = scene.world({1});
  EXPECT_LT((world->center(0) - Vector3d(3.5, 1, 1.5)).norm(), 1e-9);
  EXPECT_NEAR(world->radius(0), Vector3d(0.5, 1, 1.5).norm(), 1e-9);
  EXPECT_NEAR(world->torque_arm(0), world->radius(0), 1e-12);
}

TEST(FreeMotion, SpinUnderInertia) {
  const double h = 1e-3, torque = 2.0, steps = 60;
  const auto spin = [&](const char* name, int axis) {
    const TestScene scene(apart_parts(), dynamics(name));
    auto world = scene.world({1}, MotionSpace::rigid);
    State s = world->initial_state();
    world->advance(s, push(Vector3d::Zero(), torque * Vector3d::Unit(axis)), steps * h, nullptr);
    EXPECT_LT(displacement(*world, s).norm(), 1e-9);
    const Vector3d w = s.bodies[0].angular_velocity, turn = rotation_vector(s.bodies[0].pose.q);
    EXPECT_NEAR(turn[axis], w[axis] * h * (steps + 1) / 2, 1e-9);
    return w[axis];
  };
  const double r2 = 0.25 + 1 + 2.25;
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(spin("unit_mass", axis), steps * h * torque / r2, 1e-9);
  // Density 1: m = 6, edges 1, 2, 3.
  const double inertia[] = {6.0 / 12 * (4 + 9), 6.0 / 12 * (1 + 9), 6.0 / 12 * (1 + 4)};
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(spin("density", axis), steps * h * torque / inertia[axis], 1e-9);
}

TEST(FreeMotion, LockedOrientationIgnoresTorque) {
  for (const char* name : kAllDynamics) {
    const TestScene scene(apart_parts(), dynamics(name));
    auto world = scene.world({0});
    State with_torque = world->initial_state(), without = with_torque;
    world->advance(with_torque, push(Vector3d(1, 2, 3), Vector3d(50, 60, 70)), 0.02, nullptr);
    world->advance(without, push(Vector3d(1, 2, 3)), 0.02, nullptr);
    EXPECT_EQ(apart(with_torque, without), 0.0) << name;
    EXPECT_EQ(with_torque.bodies[0].pose.q.coeffs(), Eigen::Quaterniond::Identity().coeffs());
  }
}

TEST(FreeMotion, WrongNumbersOfBodiesAreRefused) {
  const TestScene scene(apart_parts(), {});
  auto world = scene.world({0});
  State s = world->initial_state();
  EXPECT_THROW(world->advance(s, push(Vector3d::UnitX(), Vector3d::Zero(), 2), 0.1, nullptr), std::invalid_argument);
  EXPECT_THROW(scene.world({}), std::invalid_argument);
}

}  // namespace
}  // namespace dismantle::sdf_penalty
