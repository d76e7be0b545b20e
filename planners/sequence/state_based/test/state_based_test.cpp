// The planner on slots with bends, with a path planner that never finds anything: only translations are used.
#include "state_based/state_based.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "dismantle/preparation/prepare.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/fake_planning.h"
#include "dismantle/verification/check_plan.h"
#include "state_based/evaluation.h"

namespace dismantle {
namespace {

using state_based::MotionStates;

PathResult helpless(const PathQuery&, RunContext&) { return fake::outcome(Outcome::exhausted); }

RunResult take_apart(const Assembly& assembly, const StateBasedParameters& params = {}, unsigned threads = 1) {
  RunContext context;
  context.threads = threads;
  const RunOptions options;
  RunResult r = run(assembly, fake::setup(helpless, std::make_shared<StateBased>(params)), options, context);
  const PlanCheck check = check_plan(r.plan, assembly, options.verify, context, {});
  EXPECT_TRUE(check.valid) << (check.problems.empty() ? "" : check.problems.front().message);
  return r;
}

Assembly sample(const std::string& name, const ParamSet& parameters) {
  RunContext context;
  PrepareReport report;
  return prepare_assembly(samples::make(name, parameters), name, "", {}, context, report);
}

/// A slider in a passage with three bends; a stopper, which needs two translations itself, stands in the second
/// stretch. The slider is the first part in the list, the stopper the second.
Assembly stopped_passage() {
  return fake::assembly_of({{"slider", {{{0, 0, 0}, {1, 1, 1}}}},
                            {"stopper", {{{3, 0, 1.2}, {4, 1, 2.15}}}},
                            {"housing",
                             {{{-1, -1, -1}, {7, 2, -0.05}},
                              {{-1, -1, -0.05}, {7, -0.05, 3.2}},
                              {{-1, 1.05, -0.05}, {7, 2, 3.2}},
                              {{-1, -0.05, -0.05}, {-0.05, 1.05, 3.2}},
                              {{6.05, -0.05, -0.05}, {7, 1.05, 3.2}},
                              {{4.05, -0.05, -0.05}, {6.05, 1.05, 1.15}},
                              {{-0.05, -0.05, 1.05}, {2.95, 1.05, 3.2}},
                              {{2.95, -0.05, 2.2}, {4.95, 1.05, 3.2}}}}});
}

/// The state of a run before anything was removed.
struct Beginning {
  explicit Beginning(Assembly parts, PartOrder order = PartOrder::as_given)
      : assembly(std::move(parts)),
        state({assembly, whole_assembly(assembly), constraints, objective}, {}, order, observer, context),
        sweep(assembly, oracle),
        straight(state, oracle, sweep, blocking::directions_of(assembly)),
        states(state, straight, sweep, oracle.tolerance(), {}),
        group(state.waiting().front()) {}
  /// Only states the verifier's tolerance.
  class Oracle final : public PathOracle {
   public:
    const AttemptResult& attempt(const Attempt&, RunContext&) override { throw std::logic_error("not to be asked"); }
    void prefetch(std::span<const Attempt>, RunContext&) override {}
    const AttemptResult& propose(const Attempt&, const Path&, RunContext&) override {
      throw std::logic_error("not to be asked");
    }
    OracleCounts counts() const override { return {}; }
    double tolerance() const override { return 0.01; }
  };
  class Observer final : public SequenceObserver {
    void removed(const Removal&, std::size_t) override {}
  };
  Assembly assembly;
  Oracle oracle;
  Observer observer;
  Constraints constraints;
  Objective objective;
  RunContext context;
  blocking::DisassemblyState state;
  blocking::PairSweep sweep;
  blocking::StraightMotion straight;
  MotionStates states;
  blocking::GroupState group;
};

/// Slots of any size, turned by any rotation.
TEST(StateBased, TranslatesRoundBends) {
  Rng rng(1);
  for (std::int64_t trial = 0; trial < 8; ++trial) {
    const double clearance = rng.uniform(0.1, 0.5);
    for (const Assembly& assembly :
         {sample("l_slot", {{"clearance", clearance}, {"travel", rng.uniform(8, 25)}, {"rotate_seed", trial}}),
          sample("zigzag", {{"clearance", clearance},
                            {"bends", static_cast<std::int64_t>(1 + rng.below(4))},
                            {"rotate_seed", trial}})}) {
      const RunResult r = take_apart(assembly);
      EXPECT_EQ(r.outcome, Outcome::solved);
      EXPECT_EQ(r.counts.attempts, 0u) << "nothing was searched for";
    }
  }
}

/// States that the slider reached while the stopper was there are kept and extended.
TEST(StateBased, GoesOnFromTheStatesThatItHas) {
  StateBasedParameters params;
  params.order = PartOrder::as_given;
  const RunResult r = take_apart(stopped_passage(), params);
  EXPECT_EQ(r.outcome, Outcome::solved);
  ASSERT_EQ(r.plan.disassembly.size(), 2u);
  EXPECT_EQ(r.plan.disassembly[0].separates[0][0], "stopper");
  EXPECT_EQ(r.plan.disassembly[1].separates[0][0], "slider");
  EXPECT_EQ(r.counts.attempts, 0u);

  Beginning b(stopped_passage());
  const auto slider = b.state.subassembly_of(0), stopper = b.state.subassembly_of(1);
  EXPECT_FALSE(b.states.path_out(b.group, slider));
  const std::size_t reached = b.states.size(slider);
  EXPECT_GE(reached, 2u);
  EXPECT_EQ(b.states.kept(), 0u);
  EXPECT_FALSE(b.states.path_out(b.group, slider));  // no change, so nothing is examined again
  EXPECT_EQ(b.states.size(slider), reached);
  const std::uint64_t again = b.states.kept();
  EXPECT_GT(again, 0u);
  std::erase(b.group.members, stopper);
  const auto path = b.states.path_out(b.group, slider);
  ASSERT_TRUE(path);
  EXPECT_GE(path->size(), 5u) << "along, up, along, up";
  EXPECT_GT(b.states.size(slider), reached);
  EXPECT_GT(b.states.kept(), again);
}

/// Each translation of a removal passes all other parts, and begins where the last one ended.
TEST(StateBased, PathsPassAllOthers) {
  Rng rng(2);
  for (std::int64_t trial = 0; trial < 6; ++trial) {
    Beginning b(sample("zigzag", {{"clearance", rng.uniform(0.1, 0.5)},
                                  {"bends", static_cast<std::int64_t>(1 + rng.below(3))},
                                  {"rotate_seed", trial}}));
    for (const auto id : b.group.members) {
      const auto path = b.states.path_out(b.group, id);
      if (!path) continue;
      EXPECT_EQ(path->front(), Eigen::Vector3d::Zero());
      const PartId part = b.state.part_of(id);
      for (std::size_t k = 1; k < path->size(); ++k)
        for (const Part& other : b.assembly.parts) {
          if (other.id == part) continue;
          const Pose from{(*path)[k - 1], Eigen::Quaterniond::Identity()},
              to{(*path)[k], Eigen::Quaterniond::Identity()};
          EXPECT_TRUE(b.sweep.passes(part, other.id, {}, {from, to}));
        }
      // After a refusal another path is found, or none, but never the same one.
      b.states.refuse(id);
      const auto next = b.states.path_out(b.group, id);
      EXPECT_FALSE(next && *next == *path);
    }
  }
}

/// In a pile every part is held by those above it.
TEST(StateBased, EvaluatesAPileFromTheTop) {
  for (const unsigned n : {2U, 5U, 8U}) {
    Beginning b(fake::tube_with_blocks(n));
    for (const auto id : b.group.members) b.states.path_out(b.group, id);
    std::vector<blocking::SubassemblyId> blocks;
    for (const auto id : b.group.members)
      if (b.assembly.parts[b.state.part_of(id)].name.starts_with("block")) blocks.push_back(id);
    ASSERT_EQ(blocks.size(), n);
    const auto name = [&](blocking::SubassemblyId id) { return b.assembly.parts[b.state.part_of(id)].name; };
    for (const auto id : blocks) {
      const unsigned k = static_cast<unsigned>(std::stoul(name(id).substr(5)));  // block1 is at the bottom
      const auto fewest = b.states.fewest_blockers(b.group, id, b.state.housing_of(b.group));
      ASSERT_TRUE(fewest);
      EXPECT_EQ(fewest->size(), n - k);
    }
    const auto order =
        state_based::by_evaluation(b.state, b.states, b.group, b.group.members, StateBasedEvaluation::fewest_blockers);
    for (unsigned k = 0; k < n; ++k) EXPECT_EQ(name(order[k]), "block" + std::to_string(n - k));
    EXPECT_EQ(order.back(), b.state.housing_of(b.group));
    const auto useful =
        state_based::by_evaluation(b.state, b.states, b.group, b.group.members, StateBasedEvaluation::most_useful);
    EXPECT_EQ(name(useful.front()), "block" + std::to_string(n)) << "it holds all others";
  }
}

TEST(StateBased, SamePlanOnAnyNumberOfThreads) {
  std::string plans[2];
  for (const unsigned threads : {1U, 3U}) {
    const RunResult r = take_apart(stopped_passage(), {}, threads);
    for (const auto& step : r.plan.disassembly)
      for (const auto& move : step.moves)
        for (const auto& pose : move.poses)
          plans[threads == 1 ? 0 : 1] +=
              std::to_string(pose.t.x()) + " " + std::to_string(pose.t.y()) + " " + std::to_string(pose.t.z()) + "\n";
  }
  EXPECT_FALSE(plans[0].empty());
  EXPECT_EQ(plans[0], plans[1]);
}

TEST(StateBased, SaysWhatNeverComesOut) {
  const RunResult r = take_apart(fake::closed_box());
  EXPECT_EQ(r.outcome, Outcome::exhausted);
  EXPECT_GT(r.counts.attempts, 0u) << "rotations are the path planner's";
  EXPECT_EQ(r.plan.unsolved.size(), 2u);
}

TEST(StateBased, ParametersAreDeclaredInFull) {
  EXPECT_TRUE(problems_of_schema(Schema<StateBasedParameters>().specs()).empty());
}

}  // namespace
}  // namespace dismantle
