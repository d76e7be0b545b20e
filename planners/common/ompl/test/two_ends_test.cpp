// Laws of the planners that grow from the start and from disassembled states: two trees, a roadmap.
#include <gtest/gtest.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>

#include "dismantle/ompl/connect_trees.h"
#include "dismantle/ompl/disassembled_goal.h"
#include "dismantle/ompl/roadmap.h"
#include "dismantle/ompl/space_search.h"
#include "dismantle/testing/path_checking.h"
#include "dismantle/testing/shapes.h"
#include "fake_world.h"

namespace dismantle::sampling {
namespace {

using Eigen::Vector3d;
using StateType = SamplingProblem::StateType;

/// A hollow box around the mover, with a square hole somewhere in one of its six walls.
struct Gate {
  explicit Gate(Rng& rng)
      : axis(static_cast<int>(rng.below(3))),
        sign(rng.below(2) == 0 ? -1 : 1),
        at(shapes::random_vector(rng, -1.5, 1.5)) {}
  /// `margin`: reduction of the walls' thickness.
  bool blocks(const Vector3d& t, double margin = 0) const {
    const double out = t.cwiseAbs().maxCoeff();
    if (out < 3 + margin || out > 4 - margin) return false;
    if (sign * t[axis] < out) return true;
    for (int k = 0; k < 3; ++k)
      if (k != axis && std::abs(t[k] - at[k]) > 1 + margin) return true;
    return false;
  }
  int axis;
  double sign;
  Vector3d at;
};

constexpr double kStep = 0.05;

/// A query in the box, with all objects that it refers to.
struct GateQuery {
  explicit GateQuery(const Gate& walls, MotionSpace motion = MotionSpace::translation) {
    simulator.depth = [walls](const Pose& p) { return walls.blocks(p.t) ? 1.0 : 0.0; };
    simulator.out = [](const Pose& p) { return p.t.cwiseAbs().maxCoeff() > 6; };
    prepared = simulator.prepare(assembly, 0.01, context);
    query = std::make_unique<PathQuery>(PathQuery{assembly, simulator, *prepared, scene, {}, 0.01, checker});
    budget = std::make_unique<CheckBudget>(*query, context);
    problem = std::make_unique<SamplingProblem>(*query, motion, 0.004, kStep, *budget);
  }
  template <class Planner>
  void set_up(Planner& planner, std::uint64_t seed) {
    planner.setProblemDefinition(definition_of(*problem, std::make_shared<DisassembledGoal>(*problem, 20, Rng(seed))));
  }
  RunContext context;
  fake::FakeSimulator simulator;
  Assembly assembly = shapes::assembly_of({shapes::box({-1, -1, -1}, {1, 1, 1}), shapes::box({-5, -5, -5}, {5, 5, 5})});
  Scene scene{{{0, {}}}, {{1, {}}}};
  fake::RuleChecker checker = fake::accept_all();
  std::shared_ptr<const PreparedAssembly> prepared;
  std::unique_ptr<PathQuery> query;
  std::unique_ptr<CheckBudget> budget;
  std::unique_ptr<SamplingProblem> problem;
};

std::unique_ptr<Roadmap> make(GateQuery& task, std::uint64_t seed, Roadmap*) {
  return std::make_unique<Roadmap>(*task.problem, Roadmap::Settings{}, Rng(seed));
}
std::unique_ptr<ConnectTrees> make(GateQuery& task, std::uint64_t seed, ConnectTrees*) {
  return std::make_unique<ConnectTrees>(*task.problem, 1.0, Rng(seed));
}

template <class Planner>
class TwoEnds : public testing::Test {
 protected:
  static std::unique_ptr<Planner> planner(GateQuery& task, std::uint64_t seed) {
    auto made = make(task, seed, static_cast<Planner*>(nullptr));
    task.set_up(*made, seed);
    return made;
  }
  /// Runs until there is a path or `until` checks have been made.
  static std::vector<StateType> solve(Planner& planner, GateQuery& task, std::uint64_t until = 2'000'000) {
    const ompl::base::PlannerTerminationCondition stop([&, until] { return task.budget->checks >= until; });
    return planner.solve(stop) == ompl::base::PlannerStatus::EXACT_SOLUTION ? planner.solution()
                                                                            : std::vector<StateType>{};
  }
  static bool same(const std::vector<StateType>& a, const std::vector<StateType>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const StateType& x, const StateType& y) {
      return x.center == y.center && x.turn.coeffs() == y.turn.coeffs();
    });
  }
};
using Planners = testing::Types<ConnectTrees, Roadmap>;
TYPED_TEST_SUITE(TwoEnds, Planners);

/// The path leads from the start through the hole, wherever it is, and through no wall.
TYPED_TEST(TwoEnds, FindsTheHole) {
  Rng rng(1);
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const Gate gate(rng);
    GateQuery task(gate, seed % 3 == 0 ? MotionSpace::rigid : MotionSpace::translation);
    const auto planner = this->planner(task, seed);
    const auto states = this->solve(*planner, task);
    ASSERT_FALSE(states.empty()) << "seed " << seed;
    const auto& space = task.problem->space();
    EXPECT_EQ(states.front().center, space.start().center);
    EXPECT_TRUE(task.problem->is_separated(states.back()));
    for (std::size_t k = 1; k < states.size(); ++k)
      for (double u = 0; u <= 1; u += 0.001)
        ASSERT_FALSE(gate.blocks(space.displacement(space.between(states[k - 1], states[k], u)).t, kStep));
  }
}

/// Without a hole there is no path, and the search ends when `stop` returns true.
TYPED_TEST(TwoEnds, FindsNothingWhereThereIsNothing) {
  Rng rng(2);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Gate closed(rng);
    closed.at = Vector3d::Constant(100);
    GateQuery task(closed);
    const auto planner = this->planner(task, seed);
    EXPECT_TRUE(this->solve(*planner, task, 20'000).empty());
    EXPECT_GE(task.budget->checks, 20'000u);
    EXPECT_GT(planner->nodes(), 1u);
  }
}

/// A search that is stopped and continued finds the same path as one without a stop.
TYPED_TEST(TwoEnds, InPortionsAsWithoutStops) {
  Rng rng(3);
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Gate gate(rng);
    GateQuery task(gate), again(gate);
    const auto planner = this->planner(task, seed), in_portions = this->planner(again, seed);
    const auto whole = this->solve(*planner, task);
    std::vector<StateType> pieces;
    for (std::uint64_t until = 10; pieces.empty() && until < 4'000'000; until += 97)
      pieces = this->solve(*in_portions, again, until);
    ASSERT_FALSE(whole.empty());
    EXPECT_TRUE(this->same(whole, pieces));
    EXPECT_EQ(task.budget->checks, again.budget->checks);
    EXPECT_EQ(planner->nodes(), in_portions->nodes());
  }
}

/// A discarded motion is in no later path, and other paths are found.
TYPED_TEST(TwoEnds, WhatIsDiscardedIsNotUsedAgain) {
  Rng rng(4);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    GateQuery task{Gate(rng)};
    const auto planner = this->planner(task, seed);
    std::vector<std::pair<StateType, StateType>> gone;
    for (int refusal = 0; refusal < 8; ++refusal) {
      const auto states = this->solve(*planner, task);
      ASSERT_GE(states.size(), 2u);
      for (std::size_t k = 1; k < states.size(); ++k)
        for (const auto& [a, b] : gone)
          EXPECT_FALSE((states[k - 1].center == a.center && states[k].center == b.center) ||
                       (states[k - 1].center == b.center && states[k].center == a.center));
      const std::size_t edge = 1 + rng.below(states.size() - 1);
      gone.emplace_back(states[edge - 1], states[edge]);
      planner->discard(edge);
    }
  }
}

/// Nothing is drawn from OMPL's sequence of seeds, and draws of other code do not change the result.
TYPED_TEST(TwoEnds, DependsOnItsSeedAlone) {
  Rng rng(5);
  Gate gate(rng);
  gate.at = Vector3d::Constant(1.4);  // no exit leads straight through the hole
  const auto next_seed = [] { return ompl::RNG().getLocalSeed(); };
  ompl::RNG::setSeed(17);
  const auto first = next_seed(), second = next_seed();
  ompl::RNG::setSeed(17);
  ASSERT_EQ(next_seed(), first);
  GateQuery a(gate), b(gate), c(gate);
  const auto one = this->planner(a, 1);
  const auto path = this->solve(*one, a);
  EXPECT_EQ(next_seed(), second);
  const auto same_seed = this->planner(b, 1), other_seed = this->planner(c, 2);
  EXPECT_TRUE(this->same(path, this->solve(*same_seed, b)));
  EXPECT_FALSE(this->same(path, this->solve(*other_seed, c)));
}

/// All samples of the goal are separated; the six exits come first, ordered by distance.
TEST(DisassembledGoal, SamplesAreOut) {
  Rng rng(6);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    GateQuery task(Gate(rng), seed % 2 == 0 ? MotionSpace::rigid : MotionSpace::translation);
    const DisassembledGoal goal(*task.problem, 40, Rng(seed));
    double last = 0;
    for (unsigned k = 0; k < goal.maxSampleCount(); ++k) {
      StateType state;
      goal.sampleGoal(&state);
      EXPECT_TRUE(goal.isSatisfied(&state));
      EXPECT_TRUE(task.problem->space().satisfiesBounds(&state));
      if (k >= 6) continue;
      const double length = task.problem->space().distance(task.problem->space().start(), state);
      EXPECT_GE(length, last - 1e-9);
      EXPECT_TRUE(state.turn.isApprox(Eigen::Quaterniond::Identity(), 0));
      last = length;
    }
  }
}

}  // namespace
}  // namespace dismantle::sampling
