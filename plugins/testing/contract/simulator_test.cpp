// Laws of all simulators with default parameters, depending on their capabilities.
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include "dismantle/geometry/hull.h"
#include "dismantle/plugin/finite.h"
#include "simulator_contract.h"

namespace dismantle::contract {
namespace {

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SimulatorContract);

TEST_P(SimulatorContract, DeclaresItselfInFull) {
  const PluginType& type = registry().find(PluginKind::simulator, GetParam()).type;
  EXPECT_TRUE(problems_of_schema(type.params).empty());
  EXPECT_FALSE(type.summary.empty());
  const Capabilities says = type.traits.provides, has = make()->capabilities();
  EXPECT_EQ(says.dynamics, has.dynamics);
  EXPECT_EQ(says.contacts, has.contacts);
  EXPECT_EQ(says.distance, has.distance);
  EXPECT_EQ(says.max_moving, has.max_moving);
  EXPECT_GE(has.max_moving, 1u);
}

TEST_P(SimulatorContract, WorldsBeginWhereTheCastIs) {
  for (const Made& m : all())
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      Scene scene = m.small->scene();
      scene.moving[0].pose.t = Vector3d(0.3, 0.1, 5);
      const auto world = m.world(scene, space);
      EXPECT_EQ(world->space(), space);
      EXPECT_EQ(world->scene().moving.size(), 1u);
      EXPECT_EQ(world->scene().fixed.size(), scene.fixed.size());
      const State s = world->initial_state();
      ASSERT_EQ(s.bodies.size(), 1u);
      EXPECT_TRUE(bitwise(s.bodies[0].pose, scene.moving[0].pose));
      EXPECT_TRUE(s.bodies[0].velocity.isZero(0));
      EXPECT_TRUE(s.bodies[0].angular_velocity.isZero(0));
    }
}

TEST_P(SimulatorContract, EveryPointIsWithinTheRadiusOfTheCentre) {
  for (const Made& m : all())
    for (const auto& part : m.small->assembly.parts) {
      const auto world = m.world(m.small->cast_of({part.id}));
      EXPECT_GT(world->torque_arm(0), 0);
      for (const auto& v : part.mesh->vertices)
        ASSERT_LE((v - world->center(0)).norm(), world->radius(0) + 1e-9) << part.name;
    }
}

TEST_P(SimulatorContract, SeparatedIsHullsApart) {
  Rng rng(51);
  for (const Made& m : all()) {
    const auto world = m.world();
    std::vector<Vector3d> rest;
    for (const auto& s : world->scene().fixed)
      for (const auto& v : m.small->assembly.parts[s.part].mesh->vertices) rest.push_back(s.pose * v);
    EXPECT_FALSE(world->separated(world->initial_state()));
    int apart = 0;
    for (int i = 0; i < 100; ++i) {
      const Pose pose = random_pose(rng, MotionSpace::rigid, 2.0);
      std::vector<Vector3d> moving;
      for (const auto& v : m.small->assembly.parts[m.small->leaves].mesh->vertices) moving.push_back(pose * v);
      const bool clearly = separate(moving, rest, 0.01).has_value(), at_all = separate(moving, rest).has_value();
      const bool says = world->separated(at(*world, pose));
      EXPECT_TRUE(says || !clearly);
      EXPECT_TRUE(at_all || !says);
      apart += says ? 1 : 0;
    }
    EXPECT_GT(apart, 5);
    EXPECT_LT(apart, 95);
    const Scene alone{{{m.small->leaves, Pose{}}}, {}};
    EXPECT_TRUE(m.world(alone)->separated(world->initial_state())) << "nothing stay fixed";
  }
}

TEST_P(SimulatorContract, PenetrationTellsFreeFromColliding) {
  if (!make()->capabilities().distance) GTEST_SKIP() << "it measures no distance";
  for (const Made& m : all()) {
    const auto world = m.world();
    EXPECT_EQ(world->penetration(world->initial_state()), 0.0) << "samples stand clear of each other";
    EXPECT_EQ(world->penetration(at(*world, {Vector3d(0, 0, 20), Eigen::Quaterniond::Identity()})), 0.0);
    double deepest = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        const Pose pose{0.3 * sign * Vector3d::Unit(axis), Eigen::Quaterniond::Identity()};
        const double depth = world->penetration(at(*world, pose));
        EXPECT_GE(depth, 0);
        deepest = std::max(deepest, depth);
      }
    EXPECT_GT(deepest, 0.02) << m.small->name;
  }
}

TEST_P(SimulatorContract, ContactsAreWellFormed) {
  const Capabilities has = make()->capabilities();
  if (!has.contacts) GTEST_SKIP() << "it reports no contacts";
  Rng rng(52);
  std::size_t seen = 0;
  for (const Made& m : all()) {
    const auto world = m.world();
    std::vector<Contact> contacts(3);
    world->contacts(at(*world, {Vector3d(0, 0, 50), Eigen::Quaterniond::Identity()}), contacts);
    EXPECT_TRUE(contacts.empty()) << "the content is replaced, and nothing is near";
    for (int i = 0; i < 60; ++i) {
      const State s = at(*world, random_pose(rng, MotionSpace::rigid, 0.2));
      world->contacts(s, contacts);
      double deepest = 0;
      for (const Contact& c : contacts) {
        EXPECT_EQ(c.moving, m.small->leaves);
        EXPECT_NE(c.other, m.small->leaves);
        EXPECT_LT(c.other, m.small->assembly.parts.size());
        EXPECT_NEAR(c.normal.norm(), 1, 1e-6);
        EXPECT_TRUE(c.point.allFinite());
        EXPECT_TRUE(std::isfinite(c.depth));
        deepest = std::max(deepest, c.depth);
      }
      if (has.distance) {
        EXPECT_NEAR(deepest, world->penetration(s), 1e-6) << "contacts and penetration agree";
      }
      seen += contacts.size();
    }
  }
  EXPECT_GT(seen, 100u);
}

TEST_P(SimulatorContract, WithoutDynamicsNothingAdvances) {
  if (make()->capabilities().dynamics) GTEST_SKIP() << "it has dynamics";
  const auto world = all().front().world();
  State s = world->initial_state();
  EXPECT_THROW(world->advance(s, push(*world, Vector3d::UnitX()), 0.1), std::logic_error);
}

TEST_P(SimulatorContract, FreeBodiesGoWhereTheyArePushed) {
  if (!make()->capabilities().dynamics) GTEST_SKIP() << "it has no dynamics";
  for (const Made& m : all())
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      const auto world = m.world(space);
      for (int axis = 0; axis < 3; ++axis) {
        State s = at(*world, {Vector3d(0, 0, 20), Eigen::Quaterniond::Identity()});
        const Pose begin = s.bodies[0].pose;
        Trace trace;
        const StepReport report = world->advance(s, push(*world, 100 * Vector3d::Unit(axis)), 0.1, &trace);
        const Vector3d displacement = s.bodies[0].pose * world->center(0) - begin * world->center(0);
        EXPECT_GT(displacement[axis], 1e-3);
        EXPECT_LT((displacement - displacement[axis] * Vector3d::Unit(axis)).norm(), 1e-6 * displacement[axis]);
        EXPECT_LT(angle_between(s.bodies[0].pose.q, begin.q), 1e-6);
        EXPECT_TRUE(report.finite);
        EXPECT_FALSE(report.stalled);
        EXPECT_GE(report.steps, 1u);
        EXPECT_NEAR(report.travel, displacement.norm(), 1e-6);
        ASSERT_FALSE(trace.empty());
        EXPECT_TRUE(bitwise(trace.back()[0], s.bodies[0].pose)) << "the trace ends at the state";
        EXPECT_FALSE(bitwise(trace.front()[0], begin)) << "the trace does not repeat the begin";
      }
    }
}

TEST_P(SimulatorContract, TorqueTurnsAndTranslationLocks) {
  if (!make()->capabilities().dynamics) GTEST_SKIP() << "it has no dynamics";
  for (const Made& m : all())
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      const auto world = m.world(space);
      State s = at(*world, {Vector3d(0, 0, 20), Eigen::Quaterniond::Identity()});
      const Vector3d before = s.bodies[0].pose * world->center(0);
      world->advance(s, push(*world, Vector3d::Zero(), 100 * world->torque_arm(0) * Vector3d::UnitZ()), 0.1);
      const Vector3d turn = rotation_vector(s.bodies[0].pose.q);
      EXPECT_LT((s.bodies[0].pose * world->center(0) - before).norm(), 1e-6) << "about its centre";
      if (space == MotionSpace::translation) {
        EXPECT_EQ(turn.norm(), 0);
        continue;
      }
      EXPECT_GT(turn.z(), 1e-3) << "right-handed";
      EXPECT_NEAR(s.bodies[0].pose.q.norm(), 1, 1e-9);
    }
}

TEST_P(SimulatorContract, WhatIsBlockedStaysOut) {
  const Capabilities has = make()->capabilities();
  if (!has.dynamics || !has.distance) GTEST_SKIP() << "it has no dynamics, or measures no distance";
  for (const Made& m : all())
    for (int direction = 0; direction < 6; ++direction) {
      const auto world = m.world(MotionSpace::translation);
      State s = world->initial_state();
      const Vector3d along = (direction % 2 == 0 ? 1.0 : -1.0) * Vector3d::Unit(direction / 2);
      Trace trace;
      for (int k = 0; k < 10 && !world->separated(s); ++k) world->advance(s, push(*world, 100 * along), 0.1, &trace);
      EXPECT_LT(world->penetration(s), 0.005) << m.small->name << ", direction " << direction;
      // ... and for the verifier, which is independent of the simulator.
      Path path{{Pose{}}};
      path.insert(path.end(), trace.begin(), trace.end());
      const MotionCheck check = m.small->verifier->check_motion({m.small->leaves}, world->scene().fixed, path);
      EXPECT_TRUE(check.valid) << m.small->name << ", direction " << direction;
    }
}

/// Non-finite states and actions are reported; a finite state and its trace stay finite.
TEST_P(SimulatorContract, NoNumberThatIsNotFiniteLeavesUnnoticed) {
  const Capabilities has = make()->capabilities();
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> bad{std::numeric_limits<double>::quiet_NaN(), infinity, -infinity};
  const Made& m = all().front();
  for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid})
    for (int place = 0; place < 6; ++place)
      for (const double number : bad) {
        SCOPED_TRACE(std::to_string(place) + ", " + std::to_string(number));
        const auto world = m.world(space);
        const State good = world->initial_state();
        State s = good;
        (place < 3 ? s.bodies[0].pose.t[place] : s.bodies[0].pose.q.coeffs()[place - 3]) = number;
        if (has.distance) {
          EXPECT_GT(world->penetration(s), 0) << "it is not taken for free";
        }
        EXPECT_FALSE(world->separated(s));
        if (!has.dynamics) continue;
        EXPECT_FALSE(world->advance(s, push(*world, Vector3d(0, 0, 100)), 0.1).finite);
        Action action = push(*world, Vector3d(0, 0, 100));
        (place < 3 ? action.wrenches[0].force : action.wrenches[0].torque)[place % 3] = number;
        State t = good;
        Trace trace;
        EXPECT_FALSE(world->advance(t, action, 0.1, &trace).finite);
        EXPECT_TRUE(bitwise(t.bodies[0].pose, good.bodies[0].pose));
        EXPECT_TRUE(trace.empty());
        // The world is unaffected afterwards.
        const StepReport report = world->advance(t, push(*world, Vector3d(0, 0, 100)), 0.1, &trace);
        EXPECT_TRUE(report.finite);
        for (const auto& instant : trace) EXPECT_TRUE(is_finite(instant[0]));
        EXPECT_TRUE(is_finite(t));
      }
  if (!has.dynamics) return;
  for (const double force : {1e200, 1e300, std::numeric_limits<double>::max()}) {
    const auto world = m.world(MotionSpace::rigid);
    const State good = world->initial_state();
    State s = good;
    Trace trace;
    const StepReport report =
        world->advance(s, push(*world, Vector3d(force, -force, force), Vector3d(force, 0, force)), 0.1, &trace);
    EXPECT_TRUE(is_finite(s)) << force;
    EXPECT_TRUE(report.finite || bitwise(s.bodies[0].pose, good.bodies[0].pose)) << force;
    for (const auto& instant : trace) EXPECT_TRUE(is_finite(instant[0])) << force;
  }
}

TEST_P(SimulatorContract, SameCallsSameBits) {
  const Capabilities has = make()->capabilities();
  for (const Made& m : all())
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      const Made again = made(*m.small, 3);  // another object, prepared on several threads
      const auto a = m.world(space), b = again.world(space);
      Rng rng(53);
      State s = a->initial_state(), t = b->initial_state();
      for (int k = 0; k < 15; ++k) {
        if (has.dynamics) {
          const Action action = push(*a, 100 * Vector3d(rng.normal(), rng.normal(), rng.normal()),
                                     20 * Vector3d(rng.normal(), rng.normal(), rng.normal()));
          const StepReport ra = a->advance(s, action, 0.1), rb = b->advance(t, action, 0.1);
          ASSERT_EQ(ra.steps, rb.steps);
          ASSERT_EQ(ra.stalled, rb.stalled);
        } else {
          s.bodies[0].pose = t.bodies[0].pose = random_pose(rng, space, 0.1);
        }
        ASSERT_TRUE(bitwise(s.bodies[0].pose, t.bodies[0].pose)) << m.small->name << k;
        if (has.distance) {
          ASSERT_EQ(a->penetration(s), b->penetration(t));
        }
        ASSERT_EQ(a->separated(s), b->separated(t));
      }
    }
}

TEST_P(SimulatorContract, WorldsOnSeveralThreadsDoNotDisturbEachOther) {
  const Capabilities has = make()->capabilities();
  if (!has.dynamics) GTEST_SKIP() << "it has no dynamics";
  const Made& m = all().front();
  const auto go = [&m](State& s) {
    const auto world = m.world();
    s = world->initial_state();
    for (int k = 0; k < 10; ++k)
      world->advance(s, push(*world, 100 * Vector3d::Unit(k % 3), 10 * Vector3d::Unit((k + 1) % 3)), 0.05);
  };
  State alone, together[3];
  go(alone);
  std::vector<std::thread> threads;
  for (auto& s : together) threads.emplace_back([&go, &s] { go(s); });
  for (auto& t : threads) t.join();
  for (const auto& s : together) EXPECT_TRUE(bitwise(s.bodies[0].pose, alone.bodies[0].pose));
}

TEST_P(SimulatorContract, SeveralMoveAtOnce) {
  const Capabilities has = make()->capabilities();
  if (has.max_moving < 2) GTEST_SKIP() << "it moves one part";
  for (const Made& m : all()) {
    std::vector<PartId> two{0, 1};
    const auto world = m.world(m.small->cast_of(two));
    State s = world->initial_state();
    ASSERT_EQ(s.bodies.size(), 2u);
    if (has.distance) {
      EXPECT_EQ(world->penetration(s), 0.0);
    }
    if (!has.dynamics) continue;
    Trace trace;
    world->advance(s, push(*world, Vector3d(0, 0, 100)), 0.1, &trace);
    for (const auto& instant : trace) ASSERT_EQ(instant.size(), 2u);
    if (m.small->assembly.parts.size() > 2) continue;
    for (const auto& b : s.bodies) EXPECT_GT(b.pose.t.z(), 1e-3) << "nothing stands in their way";
  }
}

TEST_P(SimulatorContract, LeavesIsTheHullOfOneApartFromAllOthers) {
  Rng rng(52);
  const bool several = make()->capabilities().max_moving > 1;
  for (const Made& m : all()) {
    const auto world = m.world(m.small->cast_of(several ? std::vector<PartId>{0, 1} : std::vector<PartId>{0}));
    const std::size_t bodies = world->scene().moving.size();
    const auto points = [&](PartId part, const Pose& pose, std::vector<Vector3d>& out) {
      for (const auto& v : m.small->assembly.parts[part].mesh->vertices) out.push_back(pose * v);
    };
    int out = 0, asked = 0;
    for (int i = 0; i < 60; ++i) {
      State s = world->initial_state();
      for (auto& b : s.bodies) b.pose = random_pose(rng, MotionSpace::rigid, 2.0);
      for (std::size_t body = 0; body < bodies; ++body) {
        std::vector<Vector3d> alone, others;
        for (std::size_t k = 0; k < bodies; ++k)
          points(world->scene().moving[k].part, s.bodies[k].pose, k == body ? alone : others);
        for (const auto& fixed : world->scene().fixed) points(fixed.part, fixed.pose, others);
        const bool clearly = separate(alone, others, 0.01).has_value(), at_all = separate(alone, others).has_value();
        const bool says = world->body_separated(s, body);
        EXPECT_TRUE(says || !clearly);
        EXPECT_TRUE(at_all || !says);
        out += says ? 1 : 0;
        ++asked;
      }
    }
    EXPECT_GT(out, 3);
    EXPECT_LT(out, asked - 3);
  }
}

TEST_P(SimulatorContract, StopsPreparingWhenTold) {
  const Small& small = small_assemblies().front();
  RunContext context;
  context.cancel.cancel();
  const auto simulator = make();
  EXPECT_NO_THROW(static_cast<void>(simulator->prepare(small.assembly, 0.01, context)));
}

INSTANTIATE_TEST_SUITE_P(Registered, SimulatorContract, testing::ValuesIn(ids(PluginKind::simulator)), test_name);

}  // namespace
}  // namespace dismantle::contract
