// Laws of all transfer planners with default parameters, on a simulator with distance queries.
#include "dismantle/transfer_planner.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "dismantle/testing/fake_planning.h"
#include "small_assemblies.h"

namespace dismantle::contract {
namespace {

/// A transfer of parts of an assembly from one place to another.
struct Errand {
  const Assembly& assembly;
  std::shared_ptr<Simulator> simulator = registry().create<Simulator>("fcl");
  std::shared_ptr<const PreparedAssembly> prepared;
  Verifier verifier;
  Scene scene;
  std::vector<Pose> goal;
  std::uint64_t most_checks = 20'000;
  bool refuse = false;
  int checked = 0, accepted = 0;

  Errand(const Assembly& a, const std::vector<PartId>& moving, const Pose& from, const Pose& to)
      : assembly(a), verifier(a, VerifyOptions{}) {
    RunContext context;
    prepared = simulator->prepare(assembly, 0.01, context);
    for (const auto& p : assembly.parts) {
      if (std::find(moving.begin(), moving.end(), p.id) == moving.end()) {
        scene.fixed.push_back({p.id, Pose{}});
        continue;
      }
      scene.moving.push_back({p.id, from});
      goal.push_back(to);
    }
  }

  bool ends_right(const Path& path) const {
    for (std::size_t k = 0; k < goal.size(); ++k) {
      const Pose &first = path.front()[k], &last = path.back()[k];
      if ((first.t - scene.moving[k].pose.t).norm() > 1e-9 || (last.t - goal[k].t).norm() > 1e-9) return false;
      if (angle_between(first.q, scene.moving[k].pose.q) > 1e-7 || angle_between(last.q, goal[k].q) > 1e-7)
        return false;
    }
    return true;
  }

  PathResult go(TransferPlanner& planner, RunContext context = {}) {
    const fake::RuleChecker checker([&](const Path& path) {
      ++checked;
      std::vector<PartId> ids;
      for (const auto& m : scene.moving) ids.push_back(m.part);
      fake::Ruling ruling;
      ruling.accept = !refuse && ends_right(path) && verifier.check_motion(ids, scene.fixed, path).valid;
      accepted += ruling.accept ? 1 : 0;
      return ruling;
    });
    const TransferQuery query{
        assembly, *simulator, *prepared, scene, goal, Eigen::Vector3d::UnitZ(), {.max_steps = most_checks},
        0.01,     checker};
    return planner.plan(query, context);
  }
};

Pose shift(double x, double y, double z) { return {Eigen::Vector3d(x, y, z), Eigen::Quaterniond::Identity()}; }
Pose turned(Pose p) {
  p.q = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);
  return p;
}

/// A block in a pipe that is open at +x, and a plate in front of the opening: straight paths are blocked.
Assembly pipe() {
  return fake::assembly_of({{"pipe",
                             {{{-2, -2, -2}, {-1.5, 2, 2}},
                              {{-1.45, -2, -2}, {2, -1, 2}},
                              {{-1.45, 1, -2}, {2, 2, 2}},
                              {{-1.45, -0.95, 1}, {2, 0.95, 2}},
                              {{-1.45, -0.95, -2}, {2, 0.95, -1}},
                              {{5, -3, -3}, {5.5, 3, 3}}}},
                            {"block", {{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}}}});
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(TransferPlannerContract);

class TransferPlannerContract : public testing::TestWithParam<std::string> {
 protected:
  static std::shared_ptr<TransferPlanner> make(const ParamSet& given = {}) {
    return registry().create<TransferPlanner>(GetParam(), given);
  }
};

TEST_P(TransferPlannerContract, DeclaresItsParametersInFull) {
  const PluginType& type = registry().find(PluginKind::transfer_planner, GetParam()).type;
  EXPECT_TRUE(problems_of_schema(type.params).empty());
  EXPECT_FALSE(type.summary.empty());
}

TEST_P(TransferPlannerContract, FindsAWayThroughFreeSpace) {
  for (const Small& small : small_assemblies())
    for (const Pose& from : {shift(8, 0, 0), turned(shift(-6, 5, 1))}) {
      Errand errand(small.assembly, {small.leaves}, from, shift(0, 0, 6));
      const PathResult r = errand.go(*make());
      ASSERT_EQ(r.outcome(), Outcome::solved) << small.name << ": " << r.message;
      EXPECT_GE(errand.accepted, 1);
      EXPECT_TRUE(errand.ends_right(r.path()->poses()));
    }
}

TEST_P(TransferPlannerContract, FindsAWayAroundACorner) {
  const Assembly assembly = pipe();
  Errand errand(assembly, {1}, shift(0, 0, 0), shift(0, 9, 0));
  const PathResult r = errand.go(*make());
  ASSERT_EQ(r.outcome(), Outcome::solved) << r.message;
  EXPECT_TRUE(errand.ends_right(r.path()->poses()));
  EXPECT_GT(r.depth, 1u);
}

TEST_P(TransferPlannerContract, SameSeedSamePath) {
  const Assembly assembly = pipe();
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    RunContext context;
    context.rng = Rng(seed);
    Errand errand(assembly, {1}, shift(0, 0, 0), turned(shift(0, 9, 0)));
    const auto planner = make();
    const PathResult a = errand.go(*planner, context), b = errand.go(*planner, context);
    ASSERT_EQ(a.outcome(), b.outcome());
    ASSERT_TRUE(a.path() && b.path());
    const Path &one = a.path()->poses(), &other = b.path()->poses();
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t k = 0; k < one.size(); ++k) EXPECT_TRUE(bitwise(one[k][0], other[k][0]));
  }
}

TEST_P(TransferPlannerContract, AGroupKeepsItsShape) {
  const Assembly assembly = fake::row(4);
  Errand errand(assembly, {0, 1}, turned(shift(0, 10, 0)), shift(0, -6, 0));
  const PathResult r = errand.go(*make());
  ASSERT_EQ(r.outcome(), Outcome::solved) << r.message;
  for (const auto& instant : r.path()->poses()) {
    EXPECT_LT((instant[0].t - instant[1].t).norm(), 1e-9);  // both have one displacement
    EXPECT_LT(angle_between(instant[0].q, instant[1].q), 1e-7);
  }
}

TEST_P(TransferPlannerContract, GivesUpWithinItsBudget) {
  const Assembly assembly = fake::closed_box();
  Errand errand(assembly, {1}, shift(9, 0, 0), Pose{});
  errand.most_checks = 400;
  const PathResult r = errand.go(*make());
  EXPECT_FALSE(is_success(r.outcome()));
  EXPECT_FALSE(r.path());
  EXPECT_EQ(errand.accepted, 0);
}

TEST_P(TransferPlannerContract, WhatIsRefusedIsNoSolution) {
  const Assembly assembly = fake::row(2);
  Errand errand(assembly, {0}, shift(0, 8, 0), shift(0, -6, 0));
  errand.refuse = true;
  errand.most_checks = 2000;
  const PathResult r = errand.go(*make());
  EXPECT_FALSE(is_success(r.outcome()));
  EXPECT_GE(errand.checked, 1);
}

TEST_P(TransferPlannerContract, StopsWhenToldTo) {
  const Assembly assembly = pipe();
  Errand errand(assembly, {1}, shift(0, 0, 0), shift(0, 9, 0));
  RunContext context;
  context.cancel.cancel();
  const PathResult r = errand.go(*make(), context);
  EXPECT_EQ(r.outcome(), Outcome::cancelled);
  EXPECT_LE(errand.checked, 1);
}

INSTANTIATE_TEST_SUITE_P(Registered, TransferPlannerContract, testing::ValuesIn(ids(PluginKind::transfer_planner)),
                         test_name);

}  // namespace
}  // namespace dismantle::contract
