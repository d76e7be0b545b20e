// Laws of all simulators with dynamics or contacts: their physics.
#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "simulator_contract.h"

namespace dismantle::contract {
namespace {

/// From rest under a constant force a body has constant speed (drag, no inertia) or constant acceleration (inertia), to
/// within one time step, independent of its position.
TEST_P(SimulatorContract, FreeFlightHasItsClosedForm) {
  if (!make()->capabilities().dynamics) GTEST_SKIP() << "it has no dynamics";
  Rng rng(54);
  for (const Made& m : all())
    for (int trial = 0; trial < 5; ++trial) {
      const auto world = m.world(MotionSpace::translation);
      const Vector3d force = 20 * Vector3d(rng.normal(), rng.normal(), rng.normal());
      const auto flight = [&](const Vector3d& from, double duration, std::uint64_t& steps) {
        State s = at(*world, {from, Eigen::Quaterniond::Identity()});
        steps = world->advance(s, push(*world, force), duration).steps;
        return Vector3d(s.bodies[0].pose.t - from);
      };
      std::uint64_t steps = 0, more_steps = 0;
      const Vector3d here(0, 0, 30), there = here + Vector3d(rng.uniform(-5, 5), rng.uniform(-5, 5), 10);
      const Vector3d once = flight(here, 0.05, steps), longer = flight(here, 0.1, more_steps);
      ASSERT_GT(once.norm(), 0);
      EXPECT_LT((flight(there, 0.05, more_steps) - once).norm(), 1e-9 * (1 + there.norm())) << "the same everywhere";
      EXPECT_LT((once.normalized() - force.normalized()).norm(), 1e-6);
      const double ratio = longer.norm() / once.norm();
      const double slack = 1e-6 + 3.0 / static_cast<double>(steps);
      EXPECT_TRUE(std::abs(ratio - 2) < 1e-6 || std::abs(ratio - 4) < slack)
          << "twice the time is " << ratio << " times as far: neither 2 (constant speed) nor 4 (constant acceleration)";
    }
}

/// Two bodies act on each other with equal and opposite forces: one loses as much travel as the other gains, each
/// relative to its free travel.
TEST_P(SimulatorContract, ContactForcesAreEqualAndOpposite) {
  const Capabilities has = make()->capabilities();
  if (!has.dynamics || has.max_moving < 2) GTEST_SKIP() << "it moves no two bodies";
  for (const Made& m : all()) {
    if (m.small->name != "peg_in_hole") continue;  // walls on all sides but z
    const auto world = m.world(m.small->cast_of({0, 1}), MotionSpace::translation);
    for (int direction = 0; direction < 4; ++direction) {
      const Vector3d force = 100 * (direction % 2 == 0 ? 1.0 : -1.0) * Vector3d::Unit(direction / 2);
      const auto pushed = [&](State s, const Vector3d& first, const Vector3d& second) {
        const State before = s;
        const Action action{{{first, Vector3d::Zero()}, {second, Vector3d::Zero()}}};
        world->advance(s, action, 0.2);
        return std::pair{(s.bodies[0].pose.t - before.bodies[0].pose.t).dot(force.normalized()),
                         (s.bodies[1].pose.t - before.bodies[1].pose.t).dot(force.normalized())};
      };
      State apart = world->initial_state();
      apart.bodies[0].pose.t.z() = 100;
      const auto [free_0, none] = pushed(apart, force, Vector3d::Zero());
      const auto [none_too, free_1] = pushed(apart, Vector3d::Zero(), force);
      EXPECT_EQ(none, 0);
      EXPECT_EQ(none_too, 0);
      const auto [carrier, carried] = pushed(world->initial_state(), force, Vector3d::Zero());
      EXPECT_LT(carrier, 0.95 * free_0) << m.small->name << ": nothing was in the way, direction " << direction;
      EXPECT_GT(carried, 0);
      EXPECT_NEAR(carrier / free_0 + carried / free_1, 1, 0.02) << m.small->name << ", direction " << direction;
    }
  }
}

/// The normal of the deepest contact is the negative gradient of the depth: one unit of displacement reduces the depth
/// by one unit. Tested by finite differences of the penetration, where a single contact is the deepest.
TEST_P(SimulatorContract, NormalsAreGradientsOfTheDepth) {
  const Capabilities has = make()->capabilities();
  if (!has.contacts || !has.distance) GTEST_SKIP() << "it reports no contacts, or measures no distance";
  Rng rng(55);
  const double shift = 1e-5;  // the assemblies are 3 long
  std::vector<double> slopes;
  for (const Made& m : all()) {
    const auto world = m.world();
    std::vector<Contact> contacts;
    for (int i = 0; i < 60; ++i) {
      const Pose pose = random_pose(rng, MotionSpace::rigid, 0.1);
      world->contacts(at(*world, pose), contacts);
      const auto deepest = std::max_element(contacts.begin(), contacts.end(),
                                            [](const Contact& a, const Contact& b) { return a.depth < b.depth; });
      if (deepest == contacts.end() || deepest->depth < 100 * shift || deepest->on_edge) continue;
      const Vector3d by = shift * deepest->normal;
      const double out = world->penetration(at(*world, {pose.t + by, pose.q}));
      const double in = world->penetration(at(*world, {pose.t - by, pose.q}));
      slopes.push_back((out - in) / (2 * shift));
    }
  }
  ASSERT_GT(slopes.size(), 20u);
  std::sort(slopes.begin(), slopes.end());
  EXPECT_NEAR(slopes[slopes.size() / 2], -1, 0.05) << "the median of " << slopes.size();
  EXPECT_LT(slopes[slopes.size() * 3 / 4], -0.5);
}

/// With a parameter `time_step`: each halving of the step changes the motion by less than the halving before.
TEST_P(SimulatorContract, ConvergesWithTheTimeStep) {
  if (!make()->capabilities().dynamics) GTEST_SKIP() << "it has no dynamics";
  const auto& params = registry().find(PluginKind::simulator, GetParam()).type.params;
  const auto spec =
      std::find_if(params.begin(), params.end(), [](const ParamSpec& p) { return p.name == "time_step"; });
  if (spec == params.end()) GTEST_SKIP() << "it has no parameter 'time_step'";
  const double step = std::get<double>(spec->fallback);
  const Small& small = small_assemblies().front();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vector3d> ends;
    double travel = 0;
    for (const double share : {1.0, 0.5, 0.25}) {
      Made m{registry().create<Simulator>(GetParam(), {{"time_step", share * step}}), nullptr, &small};
      RunContext context;
      m.prepared = m.simulator->prepare(small.assembly, 0.01, context);
      const auto world = m.world(MotionSpace::translation);
      State s = world->initial_state();
      world->advance(s, push(*world, 50 * Vector3d::Unit(axis)), 0.1);
      ends.push_back(s.bodies[0].pose.t);
      travel = std::max(travel, ends.back().norm());
    }
    const double first = (ends[0] - ends[1]).norm(), second = (ends[1] - ends[2]).norm();
    EXPECT_LE(second, std::max(0.8 * first, 0.02 * travel)) << "axis " << axis;
  }
}

}  // namespace
}  // namespace dismantle::contract
