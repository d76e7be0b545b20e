// Penalty contact of a box on a plate, in closed form (equation 1), and walls that block.
#include <cmath>

#include "scene.h"

namespace dismantle::sdf_penalty {
namespace {

using namespace test;

/// A unit cube on a plate; `gap` between them.
std::vector<Mesh> cube_on_plate(double gap = 0) {
  return {box(Vector3d(-0.5, -0.5, gap), Vector3d(0.5, 0.5, gap + 1)), box(Vector3d(-4, -4, -1), Vector3d(4, 4, 0))};
}

TEST(Contact, DepthAndNormalInClosedForm) {
  const TestScene scene(cube_on_plate(), with({}));
  auto world = scene.world({0});
  for (const double depth : {-0.01, -1e-4, 1e-4, 0.004, 0.02}) {
    const State s = at(*world, shift(0.3, -0.2, -depth));
    std::vector<Contact> contacts{Contact{}};
    world->contacts(s, contacts);
    ASSERT_EQ(contacts.size(), 4u) << "one per lower corner at depth " << depth;
    for (const Contact& c : contacts) {
      EXPECT_EQ(c.moving, 0u);
      EXPECT_EQ(c.other, 1u);
      EXPECT_NEAR(c.depth, depth, 1e-12);
      EXPECT_LT((c.normal - Vector3d::UnitZ()).norm(), 1e-12);
      EXPECT_NEAR(c.point.z(), -depth, 1e-12);
      EXPECT_NEAR(std::abs(c.point.x() - 0.3), 0.5, 1e-12);
      EXPECT_NEAR(std::abs(c.point.y() + 0.2), 0.5, 1e-12);
    }
    EXPECT_NEAR(world->penetration(s), std::max(0.0, depth), 1e-12);
  }
}

TEST(Contact, FromTheOtherSideTooWithTheNormalOnTheMovingPart) {
  // The plate moves and the cube is fixed: the points are the cube's, the normal pushes the plate down.
  const TestScene scene(cube_on_plate(), with({}));
  auto world = scene.world({1});
  std::vector<Contact> contacts;
  world->contacts(at(*world, shift(0, 0, 0.006)), contacts);
  ASSERT_EQ(contacts.size(), 4u);
  for (const Contact& c : contacts) {
    EXPECT_EQ(c.moving, 1u);
    EXPECT_EQ(c.other, 0u);
    EXPECT_NEAR(c.depth, 0.006, 1e-12);
    EXPECT_LT((c.normal + Vector3d::UnitZ()).norm(), 1e-12);
  }
}

TEST(Contact, NothingPenetratesWhenFree) {
  const TestScene scene(cube_on_plate(0.01), {});
  auto world = scene.world({0});
  Rng rng(5);
  for (int i = 0; i < 200; ++i) {
    const double up = rng.uniform(-0.0099, 3);
    EXPECT_EQ(world->penetration(at(*world, shift(rng.uniform(-6, 6), rng.uniform(-6, 6), up))), 0.0);
  }
}

TEST(Contact, ThresholdAllowsThatMuch) {
  const TestScene scene(cube_on_plate(), with({{"contact_threshold", 0.01}}));
  auto world = scene.world({0});
  EXPECT_EQ(world->penetration(at(*world, shift(0, 0, -0.0099))), 0.0);
  EXPECT_NEAR(world->penetration(at(*world, shift(0, 0, -0.013))), 0.003, 1e-12);
}

TEST(Contact, AtRestTheSinkIsForceOverStiffnessAndPoints) {
  for (const char* name : {"quasi_static", "unit_mass", "density"})
    for (const double stiffness : {1e6, 4e6})
      for (const double force : {20.0, 400.0}) {
        const TestScene scene(cube_on_plate(), dynamics(name, {{"contact_stiffness", stiffness}}));
        auto world = scene.world({0});
        State s = world->initial_state();
        world->advance(s, push(Vector3d(0, 0, -force)), 0.5, nullptr);
        const double sink = force / (4 * stiffness);
        // The advance ends when a step no longer moves: up to (drag / dt) / (drag / dt + k n) of the sink may be
        // missing.
        const double left = 6e-3 * sink;
        EXPECT_NEAR(-displacement(*world, s).z(), sink, left) << name << " " << stiffness << " " << force;
        EXPECT_NEAR(world->penetration(s), sink, left);
        EXPECT_LT(s.bodies[0].velocity.norm(), 1e-3);
      }
}

TEST(Contact, PushedAgainstAWallABodyComesToAStandstillAndSaysSo) {
  for (const char* name : {"quasi_static", "unit_mass", "density"})
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      SCOPED_TRACE(name);
      const TestScene scene(cube_on_plate(), dynamics(name, {}));
      auto world = scene.world({0}, space);
      State s = world->initial_state();
      StepReport report;
      for (int k = 0; k < 20 && !report.stalled; ++k)
        report = world->advance(s, push(Vector3d(0, 0, -100)), 0.1, nullptr);
      EXPECT_TRUE(report.stalled);
      s = world->initial_state();
      for (int k = 0; k < 5; ++k)
        EXPECT_FALSE(world->advance(s, push(Vector3d(0, 0, 100)), 0.1, nullptr).stalled) << "free, " << k;
    }
}

TEST(Contact, AtRestAllForcesBalanceWithManyPointsToo) {
  for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
    const TestScene scene(cube_on_plate(), {{"contact_spacing", 0.1}});
    auto world = scene.world({0}, space);
    State s = world->initial_state();
    const StepReport report = world->advance(s, push(Vector3d(0, 0, -100)), 1.0, nullptr);
    EXPECT_TRUE(report.stalled);
    std::vector<Contact> contacts;
    world->contacts(s, contacts);
    Vector3d total = Vector3d::Zero(), torque = Vector3d::Zero();
    int touching = 0;
    for (const Contact& c : contacts) {
      if (c.depth <= 0) continue;
      ++touching;
      const Vector3d f = 1e6 * c.depth * c.normal;
      total += f;
      torque += (c.point - s.bodies[0].pose * world->center(0)).cross(f);
    }
    EXPECT_GE(touching, 20);
    EXPECT_LT((total - Vector3d(0, 0, 100)).norm(), 0.1);
    EXPECT_LT(torque.norm(), 0.1);
  }
}

TEST(Contact, DampingSlowsTheFallAndNotTheSink) {
  double deepest[2];
  for (int damped = 0; damped < 2; ++damped) {
    const TestScene scene(cube_on_plate(), dynamics("unit_mass", {{"contact_damping", damped == 0 ? 0.0 : 1e5}}));
    auto world = scene.world({0});
    State s = world->initial_state();
    s.bodies[0].velocity = Vector3d(0, 0, -2);
    deepest[damped] = 0;
    for (int k = 0; k < 20; ++k) {
      world->advance(s, push(Vector3d(0, 0, -100)), 1e-3, nullptr);
      deepest[damped] = std::max(deepest[damped], -displacement(*world, s).z());
    }
    s.bodies[0].velocity.setZero();
    world->advance(s, push(Vector3d(0, 0, -100)), 1.0, nullptr);
    EXPECT_NEAR(-displacement(*world, s).z(), 100 / 4e6, 1e-2 * 100 / 4e6);
  }
  EXPECT_LE(deepest[1], deepest[0]);
}

TEST(Contact, SlidingAlongAWallKeepsFullSpeed) {
  for (const double spacing : {10.0, 0.1}) {
    const TestScene scene(cube_on_plate(), {{"contact_spacing", spacing}});
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      auto world = scene.world({0}, space);
      State s = world->initial_state();
      world->advance(s, push(Vector3d(60, 30, -100)), 0.5, nullptr);
      EXPECT_LT((displacement(*world, s) - Vector3d(0.75, 0.375, 0)).norm(), 1e-3);
      EXPECT_LT((displacement(*world, s) - Vector3d(0.75, 0.375, 0)).head<2>().norm(), 1e-6);
      EXPECT_LT(angle_between(s.bodies[0].pose.q, Eigen::Quaterniond::Identity()), 1e-4);
    }
  }
  const TestScene scene(cube_on_plate(), dynamics("unit_mass"));
  auto world = scene.world({0});
  State s = world->initial_state();
  world->advance(s, push(Vector3d(10, 0, -100)), 0.2, nullptr);
  EXPECT_NEAR(displacement(*world, s).x(), 1e-6 * 10 * 200 * 201 / 2, 1e-9) << "as if there were no plate";
}

TEST(Contact, AFlushBlockInASlotLeavesAlongIt) {
  // No clearance: floor and both walls touch, and nothing may block along the slot.
  const Mesh floor = box(Vector3d(-3, -2, -1), Vector3d(3, 2, 0));
  const Mesh left = box(Vector3d(-3, -2, 0), Vector3d(3, -0.5, 2)),
             right = box(Vector3d(-3, 0.5, 0), Vector3d(3, 2, 2));
  const TestScene scene({box(Vector3d(-0.5, -0.5, 0), Vector3d(0.5, 0.5, 1)), floor, left, right}, {});
  auto world = scene.world({0});
  EXPECT_LT(world->penetration(world->initial_state()), 1e-12);
  for (const double sign : {1.0, -1.0}) {
    State s = world->initial_state();
    world->advance(s, push(Vector3d(sign * 100, 0, 0)), 0.4, nullptr);
    EXPECT_NEAR(displacement(*world, s).x(), sign, 1e-3);
  }
  State s = world->initial_state();
  world->advance(s, push(Vector3d(0, 100, 0)), 0.4, nullptr);
  EXPECT_LT(displacement(*world, s).norm(), 1e-3);
}

/// A plate in a closed room whose walls are thinner than a field cell; its clearance is 0.1 on every side.
TEST(Contact, AThinClosedWallIsNeverPassed) {
  const Vector3d room(0.9, 0.7, 0.25);
  std::vector<Mesh> parts{box(-(room - Vector3d::Constant(0.1)), room - Vector3d::Constant(0.1)),
                          closed_room(room, 0.03)};
  for (const char* name : {"quasi_static", "unit_mass", "density"}) {
    const TestScene scene(parts, {{"dynamics", std::string(name)}});
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid})
      for (const double force : {100.0, 1e4, 1e5})
        for (int direction = 0; direction < 6; ++direction) {
          auto world = scene.world({0}, space);
          State s = world->initial_state();
          const Vector3d along = (direction % 2 == 0 ? 1.0 : -1.0) * Vector3d::Unit(direction / 2);
          double furthest = 0;
          // A hundred steps: a free part would move more than a unit.
          const double duration = std::string(name) == "quasi_static" ? 0.8 / force : 0.01;
          for (int k = 0; k < 10; ++k) {
            world->advance(s, push(force * along), duration, nullptr);
            furthest = std::max(furthest, displacement(*world, s).dot(along));
          }
          EXPECT_LT(furthest, 0.1 + 0.01) << name << ", force " << force << ", direction " << direction;
          EXPECT_GT(furthest, 0.09) << name << ", force " << force << ", direction " << direction;
          EXPECT_FALSE(world->separated(s));
        }
  }
}

TEST(Contact, AThinClosedWallHoldsAgainstPushesFromAllSides) {
  const Vector3d room(0.9, 0.7, 0.25);
  const TestScene scene({box(Vector3d(-0.6, -0.4, -0.02), Vector3d(0.6, 0.4, 0.02)), closed_room(room, 0.03)}, {});
  Rng rng(11);
  for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
    auto world = scene.world({0}, space);
    State s = world->initial_state();
    for (int k = 0; k < 150; ++k) {
      const Vector3d force(rng.normal(), rng.normal(), rng.normal()), torque(rng.normal(), rng.normal(), rng.normal());
      world->advance(s, push(200 * force.normalized(), 200 * world->torque_arm(0) * torque.normalized()), 0.1, nullptr);
      for (const auto& v : scene.assembly.parts[0].mesh->vertices) {
        const Vector3d out = (s.bodies[0].pose * v).cwiseAbs() - room;
        ASSERT_LT(out.maxCoeff(), 0.01) << "push " << k;
      }
    }
  }
}

TEST(Contact, LearnedPointsTouchLikeAnyOther) {
  // A needle between two contact points of nothing: the plate's flat side has no points, the needle's end has four.
  const TestScene scene(cube_on_plate(0.005), with({}));
  auto world = scene.world({0});
  std::vector<Contact> before, after;
  const State s = at(*world, shift(0, 0, -0.009));
  world->contacts(s, before);
  world->add_contact_sample(0, 1, Vector3d(0.1, 0.2, 0.005));
  world->contacts(s, after);
  ASSERT_EQ(after.size(), before.size() + 1);
  EXPECT_EQ(std::count_if(after.begin(), after.end(),
                          [](const Contact& c) {
                            return (c.point - Vector3d(0.1, 0.2, -0.004)).norm() < 1e-9 &&
                                   std::abs(c.depth - 0.004) < 1e-9;
                          }),
            1);
}

TEST(Contact, SeparatedMeansHullsApart) {
  const TestScene scene(cube_on_plate(0.01), {});
  auto world = scene.world({0});
  EXPECT_TRUE(world->separated(world->initial_state()));
  EXPECT_FALSE(world->separated(at(*world, shift(0, 0, -0.0101))));
  EXPECT_TRUE(world->separated(at(*world, shift(4.6, 0, -3))));
  EXPECT_FALSE(world->separated(at(*world, shift(4.4, 0, -0.5))));
  // A ring's hole is inside its hull.
  const TestScene ring({box(Vector3d(-0.1, -0.1, -0.1), Vector3d(0.1, 0.1, 0.1)), closed_room(Vector3d(1, 1, 1), 0.2)},
                       {});
  auto caught = ring.world({0});
  EXPECT_FALSE(caught->separated(caught->initial_state()));
  EXPECT_TRUE(ring.simulator->world(ring.assembly, *ring.prepared, {{{0, Pose{}}}, {}}, MotionSpace::rigid)
                  ->separated(caught->initial_state()));
}

}  // namespace
}  // namespace dismantle::sdf_penalty
