// One world for many states: culling and hints may save work, never change an answer. And several bodies at once.
#include <cmath>
#include <tuple>

#include "scene.h"

namespace dismantle::sdf_penalty {
namespace {

using namespace test;

Mesh cylinder(double radius, double height, int around, const Vector3d& base) {
  Mesh m;
  for (int level = 0; level < 2; ++level)
    for (int i = 0; i < around; ++i) {
      const double a = 2 * M_PI * i / around;
      m.vertices.push_back(base + Vector3d(radius * std::cos(a), radius * std::sin(a), level * height));
    }
  const auto n = static_cast<std::uint32_t>(around);
  m.vertices.push_back(base);
  m.vertices.push_back(base + Vector3d(0, 0, height));
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    m.triangles.push_back({i, j, n + j});
    m.triangles.push_back({i, n + j, n + i});
    m.triangles.push_back({2 * n, j, i});
    m.triangles.push_back({2 * n + 1, n + i, n + j});
  }
  return m;
}

/// A pin of several shells among a room, posts and a plate that overlaps the room.
TestScene crowd(double overlap = 0) {
  Mesh pin = joined(cylinder(0.3, 1.4, 20, Vector3d(0, 0, -0.7)), cylinder(0.5, 0.2, 24, Vector3d(0, 0, 0.4)));
  return TestScene(
      {std::move(pin), closed_room(Vector3d(1.5, 1.2, 1), 0.05), cylinder(0.2, 2, 16, Vector3d(0.9, 0, -1)),
       box(Vector3d(-1.52, -1, -1.1), Vector3d(-1.2, 1, 1)), box(Vector3d(2, 2, 2), Vector3d(3, 3, 3))},
      {}, {{0, 1, overlap}, {0, 2, 0.5 * overlap}});
}

using Key = std::tuple<double, double, double, double, double, double, double, PartId, PartId>;

std::vector<Key> listed(World& world, const State& state) {
  std::vector<Contact> contacts;
  world.contacts(state, contacts);
  std::vector<Key> keys;
  for (const Contact& c : contacts)
    keys.emplace_back(c.depth, c.point.x(), c.point.y(), c.point.z(), c.normal.x(), c.normal.y(), c.normal.z(),
                      c.moving, c.other);
  std::sort(keys.begin(), keys.end());
  return keys;
}

Pose random_move(Rng& rng, double size, double turn) {
  const Vector3d t(rng.normal(), rng.normal(), rng.normal()), w(rng.normal(), rng.normal(), rng.normal());
  return {size * t, rotation_from_vector(turn * w)};
}

TEST(Reuse, AWarmWorldListsTheContactsOfAFreshOne) {
  for (const double overlap : {0.0, 0.012, 0.06})
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      SCOPED_TRACE(overlap);
      const TestScene scene = crowd(overlap);
      auto warm = scene.world({0}, space);
      Rng rng(21);
      State s = warm->initial_state();
      std::size_t seen = 0;
      for (int i = 0; i < 600; ++i) {
        const double turn = space == MotionSpace::rigid ? 1.0 : 0.0;
        Pose& pose = s.bodies[0].pose;
        switch (rng.below(4)) {
          case 0:  // crawl
            pose = random_move(rng, 1e-4, turn * 1e-4) * pose;
            break;
          case 1:
            pose = random_move(rng, 0.01, turn * 0.01) * pose;
            break;
          case 2:
            pose = random_move(rng, 0.1, turn * 0.3) * pose;
            break;
          default:  // jump
            pose = random_move(rng, 0.8, turn);
        }
        auto fresh = scene.world({0}, space);
        const auto a = listed(*warm, s), b = listed(*fresh, s);
        ASSERT_EQ(a, b) << "state " << i;
        ASSERT_EQ(warm->penetration(s), fresh->penetration(s));
        seen += a.size();
      }
      EXPECT_GT(seen, 2000u) << "the states are of interest";
    }
}

TEST(Reuse, TwoMovingBodiesToo) {
  const TestScene scene = crowd();
  auto warm = scene.world({0, 2}, MotionSpace::rigid);
  Rng rng(22);
  State s = warm->initial_state();
  std::size_t seen = 0;
  for (int i = 0; i < 200; ++i) {
    for (auto& body : s.bodies)
      if (rng.below(3) > 0) body.pose = random_move(rng, rng.below(2) == 0 ? 0.005 : 0.1, 0.05) * body.pose;
    if (rng.below(10) == 0) s = warm->initial_state();
    auto fresh = scene.world({0, 2}, MotionSpace::rigid);
    const auto a = listed(*warm, s), b = listed(*fresh, s);
    ASSERT_EQ(a, b) << "state " << i;
    seen += a.size();
  }
  EXPECT_GT(seen, 500u);
}

TEST(Reuse, AdvancingDoesNotDependOnWhatTheWorldDidBefore) {
  const TestScene scene = crowd();
  for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
    auto warm = scene.world({0}, space);
    Rng rng(23);
    for (int i = 0; i < 25; ++i) {
      State s = warm->initial_state();
      if (i > 0) s.bodies[0].pose = random_move(rng, 0.1, space == MotionSpace::rigid ? 0.1 : 0.0);
      const Action action = push(100 * Vector3d(rng.normal(), rng.normal(), rng.normal()),
                                 30 * Vector3d(rng.normal(), rng.normal(), rng.normal()));
      auto fresh = scene.world({0}, space);
      State a = s, b = s;
      Trace trace_a, trace_b;
      warm->advance(a, action, 0.1, &trace_a);
      fresh->advance(b, action, 0.1, &trace_b);
      ASSERT_EQ(apart(a, b), 0.0) << "state " << i;
      ASSERT_EQ(trace_a.size(), trace_b.size());
      // Answers about a state do not depend on the history.
      auto witness = scene.world({0}, space);
      EXPECT_NEAR(warm->penetration(a), witness->penetration(a), 1e-6) << "state " << i;
      const auto touching = [&](World& world) {
        const auto all = listed(world, a);
        return std::count_if(all.begin(), all.end(), [](const Key& k) { return std::get<0>(k) > 1e-5; });
      };
      EXPECT_EQ(touching(*warm), touching(*witness)) << "state " << i;
    }
  }
}

TEST(Reuse, SameCallsSameBits) {
  for (const char* name : {"quasi_static", "unit_mass", "density"}) {
    std::vector<State> ends;
    for (int run = 0; run < 2; ++run) {
      const TestScene scene(
          {box(Vector3d(-0.5, -0.5, 0.01), Vector3d(0.5, 0.5, 1)), box(Vector3d(-4, -4, -1), Vector3d(4, 4, 0)),
           box(Vector3d(0.6, -1, 0.01), Vector3d(1, 1, 1))},
          {{"dynamics", std::string(name)}});
      auto world = scene.world({0}, MotionSpace::rigid);
      State s = world->initial_state();
      Rng rng(24);
      for (int k = 0; k < 12; ++k)
        world->advance(s, push(50 * Vector3d(rng.normal(), rng.normal(), rng.normal()), 20 * Vector3d::Unit(k % 3)),
                       0.1, nullptr);
      ends.push_back(s);
    }
    EXPECT_EQ(apart(ends[0], ends[1]), 0.0) << name;
    EXPECT_EQ(ends[0].bodies[0].velocity, ends[1].bodies[0].velocity) << name;
  }
}

/// Two cubes 0.1 apart along x, a fixed one far away.
std::vector<Mesh> two_cubes() {
  return {box(Vector3d(0, 0, 0), Vector3d(1, 1, 1)), box(Vector3d(1.1, -0.2, -0.2), Vector3d(2.1, 1.2, 1.2)),
          box(Vector3d(-20, 0, 0), Vector3d(-19, 1, 1))};
}

TEST(TwoBodies, PushEachOtherAtHalfTheSpeed) {
  for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
    const TestScene scene(two_cubes(), {});
    auto world = scene.world({0, 1}, space);
    Action action = push(Vector3d(100, 0, 0), Vector3d::Zero(), 2);
    action.wrenches[1].force.setZero();
    State s = world->initial_state();
    world->advance(s, action, 0.04, nullptr);  // 2.5 units / s: the gap is closed
    EXPECT_NEAR(displacement(*world, s, 0).x(), 0.1, 1e-3);
    EXPECT_NEAR(displacement(*world, s, 1).x(), 0.0, 1e-3);
    world->advance(s, action, 0.4, nullptr);
    EXPECT_NEAR(displacement(*world, s, 0).x(), 0.6, 2e-3) << "two drags, one force";
    EXPECT_NEAR(displacement(*world, s, 1).x(), 0.5, 2e-3);
    EXPECT_LT(world->penetration(s), 1e-3);
  }
}

TEST(TwoBodies, KeepTheirMomentum) {
  for (const char* name : {"unit_mass", "density"}) {
    const TestScene scene(two_cubes(), dynamics(name));
    auto world = scene.world({0, 1});
    Action action = push(Vector3d(80, 0, 0), Vector3d::Zero(), 2);
    action.wrenches[1].force.setZero();
    State s = world->initial_state();
    world->advance(s, action, 0.15, nullptr);
    const bool unit = std::string(name) == "unit_mass";
    const double m0 = 1, m1 = unit ? 1 : 1.4 * 1.4;
    EXPECT_NEAR(m0 * s.bodies[0].velocity.x() + m1 * s.bodies[1].velocity.x(), 80 * 0.15, 1e-6) << name;
    EXPECT_GT(displacement(*world, s, 1).x(), 0.1) << name;
    EXPECT_LT(world->penetration(s), 5e-3) << name;
  }
}

TEST(TwoBodies, OppositeForcesBalance) {
  const TestScene scene(two_cubes(), with({}));
  auto world = scene.world({0, 1});
  Action action = push(Vector3d(100, 0, 0), Vector3d::Zero(), 2);
  action.wrenches[1].force = Vector3d(-100, 0, 0);
  State s = world->initial_state();
  const StepReport report = world->advance(s, action, 1.0, nullptr);
  EXPECT_TRUE(report.stalled);
  EXPECT_NEAR(displacement(*world, s, 0).x(), 0.05, 1e-3) << "they meet in the middle";
  EXPECT_NEAR(displacement(*world, s, 1).x(), -0.05, 1e-3);
  EXPECT_NEAR(world->penetration(s), 100 / 4e6, 1e-6) << "four corners of the smaller one";
  std::vector<Contact> contacts;
  world->contacts(s, contacts);
  Vector3d on_first = Vector3d::Zero(), on_second = Vector3d::Zero();
  for (const Contact& c : contacts)
    if (c.depth > 0) (c.moving == 0 ? on_first : on_second) += 1e6 * c.depth * c.normal;
  EXPECT_NEAR(on_first.x() - on_second.x(), -100, 2);
}

TEST(TwoBodies, ApartTheyDoNotInteract) {
  for (const char* name : {"quasi_static", "unit_mass", "density"})
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      const TestScene scene(two_cubes(), dynamics(name));
      auto both = scene.world({0, 1}, space);
      Action action = push(Vector3d(-30, 10, 0), Vector3d(0, 0, 2), 2);
      action.wrenches[1] = {Vector3d(40, 0, 5), Vector3d(1, 0, 0)};
      State s = both->initial_state();
      both->advance(s, action, 0.1, nullptr);
      for (const PartId part : {0u, 1u}) {
        const Scene alone{{{part, Pose{}}}, {{2, Pose{}}}};
        auto world = scene.simulator->world(scene.assembly, *scene.prepared, alone, space);
        State t = world->initial_state();
        world->advance(t, {{action.wrenches[part]}}, 0.1, nullptr);
        EXPECT_LT((s.bodies[part].pose.t - t.bodies[0].pose.t).norm(), 1e-9) << name << part;
        EXPECT_LT(angle_between(s.bodies[part].pose.q, t.bodies[0].pose.q), 1e-9) << name << part;
      }
    }
}

TEST(TwoBodies, AThinWallBetweenThemHolds) {
  const TestScene scene({box(Vector3d(0, 0, 0), Vector3d(1, 1, 1)), box(Vector3d(1.1, -2, -2), Vector3d(1.13, 3, 3)),
                         box(Vector3d(-20, 0, 0), Vector3d(-19, 1, 1))},
                        {});
  auto world = scene.world({0, 1});
  Action action = push(Vector3d(3000, 0, 0), Vector3d::Zero(), 2);
  action.wrenches[1].force = Vector3d(-3000, 0, 0);
  State s = world->initial_state();
  for (int k = 0; k < 20; ++k) {
    world->advance(s, action, 0.02, nullptr);
    EXPECT_LT(displacement(*world, s, 0).x() - displacement(*world, s, 1).x(), 0.1 + 0.005);
  }
}

}  // namespace
}  // namespace dismantle::sdf_penalty
