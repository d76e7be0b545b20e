// Motion in contact, in closed form: a force projected on motions without penetration.
#include <cmath>

#include "world_scene.h"

namespace dismantle::sdf_velocity {
namespace {

using namespace sdf::test;

constexpr double kDrag = 40;

struct VelocityScene : TestScene {
  explicit VelocityScene(std::vector<Mesh> meshes) : TestScene("sdf_velocity", std::move(meshes), {}) {}
};

std::vector<Mesh> turned(std::vector<Mesh> meshes, const Eigen::Quaterniond& q) {
  for (Mesh& m : meshes)
    for (auto& v : m.vertices) v = q * v;
  return meshes;
}

Eigen::Quaterniond random_turn(Rng& rng) {
  return Eigen::Quaterniond(rng.normal(), rng.normal(), rng.normal(), rng.normal()).normalized();
}

Vector3d random_vector(Rng& rng) { return {rng.normal(), rng.normal(), rng.normal()}; }

std::vector<Mesh> cube_on_plate(double gap = 0) {
  return {box(Vector3d(-0.5, -0.5, gap), Vector3d(0.5, 0.5, gap + 1)), box(Vector3d(-6, -6, -1), Vector3d(6, 6, 0))};
}

TEST(Motion, AFreeBodyMovesAtForceOverDragAndTurnsAboutItsCentre) {
  const VelocityScene scene({box(Vector3d(0, 0, 0), Vector3d(1, 2, 3)), box(Vector3d(20, 0, 0), Vector3d(21, 1, 1))});
  Rng rng(1);
  for (int i = 0; i < 20; ++i) {
    auto world = scene.world({0}, MotionSpace::rigid);
    State s = world->initial_state();
    const Vector3d force = 60 * random_vector(rng);
    const double duration = rng.uniform(0.01, 0.2);
    const StepReport report = world->advance(s, push(force), duration, nullptr);
    EXPECT_LT((displacement(*world, s) - duration / kDrag * force).norm(), 1e-10);
    EXPECT_FALSE(report.stalled);
    s = world->initial_state();
    const double r = world->radius(0);
    const Vector3d torque = 60 * r * random_vector(rng);
    world->advance(s, push(Vector3d::Zero(), torque), duration, nullptr);
    EXPECT_LT((rotation_vector(s.bodies[0].pose.q) - duration / (kDrag * r * r) * torque).norm(), 1e-9);
    EXPECT_LT(displacement(*world, s).norm(), 1e-9);
  }
}

TEST(Motion, OnAnInclineOnlyThePartAlongItIsLeft) {
  Rng rng(2);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Quaterniond q = random_turn(rng);
    const VelocityScene scene(turned(cube_on_plate(), q));
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      auto world = scene.world({0}, space);
      State s = world->initial_state();
      // Steep enough for the cube to slide, but not to tip: the force passes through its base.
      const Vector3d along(rng.normal(), rng.normal(), 0);
      const Vector3d force = 100 * (along.normalized() - rng.uniform(1.1, 3) * Vector3d::UnitZ());
      const StepReport report = world->advance(s, push(q * force), 0.3, nullptr);
      const Vector3d expected = q * (0.3 / kDrag * Vector3d(force.x(), force.y(), 0));
      EXPECT_LT((displacement(*world, s) - expected).norm(), 1e-6);
      EXPECT_LT(angle_between(s.bodies[0].pose.q, Eigen::Quaterniond::Identity()), 1e-6);
      EXPECT_FALSE(report.stalled);
      EXPECT_LT(world->penetration(s), 1e-6);
    }
  }
}

TEST(Motion, AcrossAGapItGoesUntilItTouchesAndSlidesOn) {
  const VelocityScene scene(cube_on_plate(0.07));
  auto world = scene.world({0});
  State s = world->initial_state();
  world->advance(s, push(Vector3d(80, 0, -40)), 0.2, nullptr);
  EXPECT_LT((displacement(*world, s) - Vector3d(0.4, 0, -0.07)).norm(), 1e-9);
}

TEST(Motion, WhatRestsDoesNotDrift) {
  for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
    const VelocityScene scene(cube_on_plate());
    auto world = scene.world({0}, space);
    State s = world->initial_state();
    for (int k = 0; k < 500; ++k) EXPECT_TRUE(world->advance(s, push(Vector3d(0, 0, -100)), 0.1, nullptr).stalled);
    EXPECT_LT(displacement(*world, s).norm(), 1e-9);
    EXPECT_LT(angle_between(s.bodies[0].pose.q, Eigen::Quaterniond::Identity()), 1e-9);
    // Nor while it slides back and forth.
    for (int k = 0; k < 200; ++k)
      world->advance(s, push(Vector3d(k % 4 < 2 ? 60 : -60, k % 2 == 0 ? 30 : -30, -150)), 0.1, nullptr);
    EXPECT_LT(std::abs(displacement(*world, s).z()), 1e-6);
    EXPECT_LT(world->penetration(s), 1e-6);
  }
}

TEST(Motion, InAGrooveOnlyTheGrooveIsLeftAndInACornerNothing) {
  Rng rng(3);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Quaterniond q = random_turn(rng);
    std::vector<Mesh> meshes{box(Vector3d(0, 0, 0), Vector3d(1, 1, 1)), box(Vector3d(-1, -6, -6), Vector3d(0, 6, 6)),
                             box(Vector3d(0.0, -1, -6), Vector3d(6, 0, 6))};
    const VelocityScene groove(turned(meshes, q));
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      auto world = groove.world({0}, space);
      State s = world->initial_state();
      const double along = rng.uniform(-60, 60);
      world->advance(s, push(q * Vector3d(-90, -120, along)), 0.2, nullptr);
      EXPECT_LT((displacement(*world, s) - q * Vector3d(0, 0, 0.2 / kDrag * along)).norm(), 1e-6);
    }
    meshes.push_back(box(Vector3d(-1, -1, -1), Vector3d(6, 6, 0)));
    const VelocityScene corner(turned(meshes, q));
    auto world = corner.world({0});
    State s = world->initial_state();
    EXPECT_TRUE(world->advance(s, push(q * Vector3d(-90, -120, -20)), 0.2, nullptr).stalled);
    EXPECT_LT(displacement(*world, s).norm(), 1e-9);
    EXPECT_FALSE(world->advance(s, push(q * Vector3d(5, 10, 90)), 0.2, nullptr).stalled);
  }
}

TEST(Motion, AFlushBlockLeavesItsSlotBothWays) {
  const Mesh floor = box(Vector3d(-3, -2, -1), Vector3d(3, 2, 0));
  const Mesh left = box(Vector3d(-3, -2, 0), Vector3d(3, -0.5, 2)),
             right = box(Vector3d(-3, 0.5, 0), Vector3d(3, 2, 2));
  Rng rng(4);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Quaterniond q = i == 0 ? Eigen::Quaterniond::Identity() : random_turn(rng);
    const VelocityScene scene(turned({box(Vector3d(-0.5, -0.5, 0), Vector3d(0.5, 0.5, 1)), floor, left, right}, q));
    for (const double sign : {1.0, -1.0}) {
      auto world = scene.world({0});
      State s = world->initial_state();
      world->advance(s, push(q * Vector3d(sign * 100, 0, 0)), 0.4, nullptr);
      EXPECT_LT((displacement(*world, s) - q * Vector3d(sign, 0, 0)).norm(), 1e-6);
    }
    auto world = scene.world({0});
    State s = world->initial_state();
    EXPECT_TRUE(world->advance(s, push(q * Vector3d(0, 100, 0)), 0.4, nullptr).stalled);
    EXPECT_LT(displacement(*world, s).norm(), 1e-6);
  }
}

TEST(Motion, SeveralBodiesShareAPush) {
  // Two cubes 0.1 apart; a third one far away is fixed.
  const VelocityScene scene({box(Vector3d(0, 0, 0), Vector3d(1, 1, 1)),
                             box(Vector3d(1.1, -0.2, -0.2), Vector3d(2.1, 1.2, 1.2)),
                             box(Vector3d(-20, 0, 0), Vector3d(-19, 1, 1))});
  for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
    auto world = scene.world({0, 1}, space);
    Action action = push(Vector3d(100, 0, 0), Vector3d::Zero(), 2);
    action.wrenches[1].force.setZero();
    State s = world->initial_state();
    world->advance(s, action, 0.04, nullptr);
    EXPECT_NEAR(displacement(*world, s, 0).x(), 0.1, 1e-6) << "the gap is closed";
    EXPECT_NEAR(displacement(*world, s, 1).x(), 0.0, 1e-6);
    world->advance(s, action, 0.4, nullptr);
    EXPECT_NEAR(displacement(*world, s, 0).x(), 0.6, 1e-4) << "two drags, one force";
    EXPECT_NEAR(displacement(*world, s, 1).x(), 0.5, 1e-4);
    action.wrenches[1].force = Vector3d(-100, 0, 0);
    const Vector3d before = displacement(*world, s, 0);
    EXPECT_TRUE(world->advance(s, action, 0.4, nullptr).stalled) << "opposite forces balance";
    EXPECT_LT((displacement(*world, s, 0) - before).norm(), 1e-4);
  }
}

TEST(Motion, ATurnedSceneGivesTheTurnedMotion) {
  Rng rng(5);
  const std::vector<Mesh> meshes{box(Vector3d(-0.5, -0.4, -0.3), Vector3d(0.5, 0.4, 0.3)),
                                 closed_room(Vector3d(0.9, 0.8, 0.7), 0.04),
                                 box(Vector3d(0.6, 0.2, -0.7), Vector3d(0.9, 0.8, 0.7))};
  for (int i = 0; i < 12; ++i) {
    const Eigen::Quaterniond q = random_turn(rng);
    const VelocityScene straight(meshes), askew(turned(meshes, q));
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      auto a = straight.world({0}, space), b = askew.world({0}, space);
      State s = a->initial_state(), t = b->initial_state();
      // Long enough to reach walls and edges, but not so long that rounding decides the order of contacts.
      for (int k = 0; k < 3; ++k) {
        const Vector3d force = 60 * random_vector(rng), torque = 20 * random_vector(rng);
        a->advance(s, push(force, torque), 0.1, nullptr);
        b->advance(t, push(q * force, q * torque), 0.1, nullptr);
        // Rounding may decide whether a step is corrected in place: tolerate the depth that is not corrected.
        EXPECT_LT((q * displacement(*a, s) - displacement(*b, t)).norm(), 1e-3) << i << " " << k;
        EXPECT_LT(angle_between(q * s.bodies[0].pose.q * q.conjugate(), t.bodies[0].pose.q), 1e-3) << i << " " << k;
      }
    }
  }
}

TEST(Motion, SameCallsSameBits) {
  std::vector<State> ends;
  for (int run = 0; run < 2; ++run) {
    const VelocityScene scene({box(Vector3d(-0.5, -0.5, 0.01), Vector3d(0.5, 0.5, 1)),
                               box(Vector3d(-4, -4, -1), Vector3d(4, 4, 0)),
                               box(Vector3d(0.6, -1, 0.01), Vector3d(1, 1, 1))});
    auto world = scene.world({0}, MotionSpace::rigid);
    State s = world->initial_state();
    Rng rng(6);
    for (int k = 0; k < 20; ++k)
      world->advance(s, push(50 * random_vector(rng), 20 * Vector3d::Unit(k % 3)), 0.1, nullptr);
    ends.push_back(s);
  }
  EXPECT_EQ(apart(ends[0], ends[1]), 0.0);
}

TEST(Motion, WrongNumbersOfBodiesAreRefused) {
  const VelocityScene scene(cube_on_plate());
  auto world = scene.world({0});
  State s = world->initial_state();
  EXPECT_THROW(world->advance(s, push(Vector3d::UnitX(), Vector3d::Zero(), 2), 0.1, nullptr), std::invalid_argument);
  EXPECT_THROW(scene.world({}), std::invalid_argument);
}

}  // namespace
}  // namespace dismantle::sdf_velocity
