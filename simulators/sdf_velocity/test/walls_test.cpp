// Walls thinner than a field cell block parts at any step length.
#include "world_scene.h"

namespace dismantle::sdf_velocity {
namespace {

using namespace sdf::test;

TestScene scene_of(std::vector<Mesh> meshes, const ParamSet& given = {}) {
  return TestScene("sdf_velocity", std::move(meshes), given);
}

TEST(Walls, AThinClosedRoomStaysClosed) {
  // Its clearance is 0.1 on every side.
  const Vector3d room(0.9, 0.7, 0.25);
  const std::vector<Mesh> parts{box(-(room - Vector3d::Constant(0.1)), room - Vector3d::Constant(0.1)),
                                closed_room(room, 0.03)};
  for (const double max_travel : {0.005, 0.05, 0.1}) {
    const TestScene scene = scene_of(parts, {{"max_travel", max_travel}});
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid})
      for (const double force : {100.0, 1e4, 1e5})
        for (int direction = 0; direction < 6; ++direction) {
          auto world = scene.world({0}, space);
          State s = world->initial_state();
          const Vector3d along = (direction % 2 == 0 ? 1.0 : -1.0) * Vector3d::Unit(direction / 2);
          for (int k = 0; k < 10; ++k) world->advance(s, push(force * along), 0.8 * 100 / force, nullptr);
          EXPECT_NEAR(displacement(*world, s).dot(along), 0.1, 1e-3)
              << "force " << force << ", direction " << direction;
          EXPECT_FALSE(world->separated(s));
        }
  }
}

TEST(Walls, HoldAgainstPushesFromAllSides) {
  const Vector3d room(0.9, 0.7, 0.25);
  Rng rng(11);
  for (const double max_travel : {0.02, 0.05, 0.1}) {
    const TestScene scene =
        scene_of({box(Vector3d(-0.6, -0.4, -0.02), Vector3d(0.6, 0.4, 0.02)), closed_room(room, 0.03)},
                 {{"max_travel", max_travel}});
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      auto world = scene.world({0}, space);
      State s = world->initial_state();
      for (int k = 0; k < 150; ++k) {
        const Vector3d force(rng.normal(), rng.normal(), rng.normal()),
            torque(rng.normal(), rng.normal(), rng.normal());
        world->advance(s, push(200 * force.normalized(), 200 * world->torque_arm(0) * torque.normalized()), 0.1,
                       nullptr);
        for (const auto& v : scene.assembly.parts[0].mesh->vertices) {
          const Vector3d out = (s.bodies[0].pose * v).cwiseAbs() - room;
          ASSERT_LT(out.maxCoeff(), 0.003) << "push " << k;
        }
      }
    }
  }
}

TEST(Walls, AFinInTheWayOfASlidingBodyHolds) {
  // The points that slide on the floor are nearer to it than to the fin.
  const Mesh floor =
      joined(box(Vector3d(-4, -4, -1), Vector3d(4, 4, 0)), box(Vector3d(1, -3, -0.01), Vector3d(1.03, 3, 2)));
  for (const double max_travel : {0.02, 0.05, 0.1}) {
    const TestScene scene =
        scene_of({box(Vector3d(-0.5, -0.5, 0), Vector3d(0.5, 0.5, 1)), floor}, {{"max_travel", max_travel}});
    Rng rng(12);
    for (int i = 0; i < 20; ++i) {
      auto world = scene.world({0}, i % 2 == 0 ? MotionSpace::translation : MotionSpace::rigid);
      State s = world->initial_state();
      world->advance(s, push(Vector3d(100, rng.uniform(-30, 30), -200)), 0.4, nullptr);
      EXPECT_NEAR(displacement(*world, s).x(), 0.5, 2e-3);
      EXPECT_NEAR(displacement(*world, s).z(), 0, 2e-3);
    }
  }
}

TEST(Walls, AThinWallBetweenTwoMovingBodiesHolds) {
  const TestScene scene =
      scene_of({box(Vector3d(0, 0, 0), Vector3d(1, 1, 1)), box(Vector3d(1.1, -2, -2), Vector3d(1.13, 3, 3)),
                box(Vector3d(-20, 0, 0), Vector3d(-19, 1, 1))});
  auto world = scene.world({0, 1});
  Action action = push(Vector3d(3000, 0, 0), Vector3d::Zero(), 2);
  action.wrenches[1].force = Vector3d(-3000, 0, 0);
  State s = world->initial_state();
  for (int k = 0; k < 20; ++k) {
    world->advance(s, action, 0.02, nullptr);
    EXPECT_LT(displacement(*world, s, 0).x() - displacement(*world, s, 1).x(), 0.1 + 1e-3);
  }
}

TEST(Walls, WhatStartsInASurfaceIsLiftedOutOfIt) {
  const TestScene scene =
      scene_of({box(Vector3d(-0.5, -0.5, 0), Vector3d(0.5, 0.5, 1)), box(Vector3d(-4, -4, -1), Vector3d(4, 4, 0))});
  auto world = scene.world({0});
  for (const double depth : {1e-4, 0.003, 0.02}) {
    State s = at(*world, shift(0, 0, -depth));
    for (int k = 0; k < 5; ++k) world->advance(s, push(Vector3d(100, 0, -20)), 0.02, nullptr);
    EXPECT_NEAR(displacement(*world, s).z(), 0, 1e-3) << depth;
  }
}

}  // namespace
}  // namespace dismantle::sdf_velocity
