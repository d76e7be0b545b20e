// Laws of the tree planners: reproducible paths whatever else the process does, budgets, refusals.
#include <gtest/gtest.h>
#include <ompl/util/RandomNumbers.h>

#include <thread>

#include "dismantle/ompl/targetless.h"
#include "dismantle/ompl/tree_planner.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/path_checking.h"
#include "simulator.h"

namespace dismantle::sampling {
namespace {

using fake::Ruling;

constexpr double kTolerance = 0.01;

struct Task {
  explicit Task(const char* sample, const ParamSet& parameters, const char* moving) {
    PrepareReport report;
    assembly = prepare_assembly(samples::make(sample, parameters), sample, "", {}, context, report);
    prepared = simulator.prepare(assembly, kTolerance, context);
    verifier = std::make_unique<Verifier>(assembly, VerifyOptions{.max_penetration = kTolerance});
    for (const auto& part : assembly.parts) (part.name == moving ? scene.moving : scene.fixed).push_back({part.id, {}});
  }
  Ruling ruling_of(const Path& path) const {
    Ruling ruling;
    ruling.accept = verifier->check_motion({scene.moving[0].part}, scene.fixed, path).valid &&
                    verifier->apart({{scene.moving[0].part, path.back()[0]}}, scene.fixed);
    return ruling;
  }
  PathResult plan(std::uint64_t seed, dismantle::Budget effort, const TreeParameters& p = {},
                  std::function<Ruling(const Path&)> rule_with = {}) const {
    const fake::RuleChecker checker(rule_with ? rule_with : [this](const Path& path) { return ruling_of(path); });
    const PathQuery query{assembly, simulator, *prepared, scene, effort, kTolerance, checker};
    RunContext own;
    own.rng = Rng(seed);
    own.cancel = cancel;
    return run_to_end(*start_trees(
        query, own, p, [](SamplingProblem& problem, Rng) { return std::make_unique<NearestExit>(problem); }));
  }
  RunContext context;
  CancelToken cancel;
  mesh_collision::FclSimulator simulator{mesh_collision::Parameters{}};
  Assembly assembly;
  std::shared_ptr<const PreparedAssembly> prepared;
  std::unique_ptr<Verifier> verifier;
  Scene scene;
};

const Task& slot() {
  static const Task task("l_slot", {{"clearance", 0.5}}, "slider");
  return task;
}

constexpr dismantle::Budget kEffort{.max_steps = 100'000};

bool same(const Path& a, const Path& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x[0].t == y[0].t && x[0].q.coeffs() == y[0].q.coeffs();
  });
}

TEST(TreePlanner, SameSeedSamePath) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const PathResult a = slot().plan(seed, kEffort), b = slot().plan(seed, kEffort);
    ASSERT_EQ(a.outcome(), Outcome::solved);
    EXPECT_TRUE(same(a.path()->poses(), b.path()->poses()));
    EXPECT_EQ(a.stats, b.stats);
    EXPECT_TRUE(slot().ruling_of(a.path()->poses()).accept);
    EXPECT_TRUE(a.path()->poses().front()[0].is_identity());
  }
  EXPECT_FALSE(same(slot().plan(1, kEffort).path()->poses(), slot().plan(2, kEffort).path()->poses()));
}

/// Searches on other threads and generators of other code do not change the result.
TEST(TreePlanner, ThreadsDoNotDisturbEachOther) {
  slot();
  std::vector<PathResult> alone, together(4);
  for (std::uint64_t seed = 0; seed < 4; ++seed) alone.push_back(slot().plan(seed + 1, kEffort));
  std::vector<std::thread> threads;
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    threads.emplace_back([&together, seed] {
      const ompl::RNG disturbance;
      together[seed] = slot().plan(seed + 1, kEffort);
    });
  for (auto& t : threads) t.join();
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(same(alone[i].path()->poses(), together[i].path()->poses()));
    EXPECT_EQ(alone[i].stats, together[i].stats);
  }
}

/// Planning takes nothing from OMPL's process-wide sequence of seeds.
TEST(TreePlanner, LeavesOmplsSequenceOfSeedsAlone) {
  const auto next_seed = [] { return ompl::RNG().getLocalSeed(); };
  ompl::RNG::setSeed(17);
  const auto first = next_seed(), second = next_seed();
  ompl::RNG::setSeed(17);
  ASSERT_EQ(next_seed(), first);
  slot().plan(1, kEffort);
  EXPECT_EQ(next_seed(), second);
}

TEST(TreePlanner, KeepsToItsBudget) {
  const Task task("closed_box", {}, "plate");
  for (const std::uint64_t steps : {50, 1000}) {
    const PathResult r = task.plan(1, {.max_steps = steps});
    EXPECT_EQ(r.outcome(), Outcome::timeout);
    EXPECT_LE(r.stats.state_checks, steps + 64);
    EXPECT_EQ(r.best_pose.size(), 1u);
    EXPECT_FALSE(r.blocked_by.empty());
  }
  TreeParameters p;
  p.level_checks = 100;
  const PathResult shallow = task.plan(1, {.max_depth = 1}, p), deeper = task.plan(1, {.max_depth = 3}, p);
  EXPECT_EQ(shallow.outcome(), Outcome::depth_limit);
  EXPECT_EQ(deeper.outcome(), Outcome::depth_limit);
  EXPECT_GT(deeper.stats.state_checks, 3 * shallow.stats.state_checks);
}

TEST(TreePlanner, StopsWhenCancelled) {
  Task task("closed_box", {}, "plate");
  task.cancel.cancel();
  EXPECT_EQ(task.plan(1, {}).outcome(), Outcome::cancelled);
}

/// When the verifier refuses a path, the edge at fault is removed and the search continues.
TEST(TreePlanner, GoesOnAfterARefusal) {
  int shown = 0;
  const auto strict = [&](const Path& path) {
    Ruling ruling = slot().ruling_of(path);
    if (++shown <= 5) {
      ruling.accept = false;
      ruling.has_witness = shown % 2 == 0;
      ruling.instant = path.size() / 2;
    }
    return ruling;
  };
  const PathResult r = slot().plan(1, {.max_steps = 400'000}, {}, strict);
  EXPECT_EQ(r.outcome(), Outcome::solved);
  EXPECT_EQ(r.stats.refused, 5u);
  EXPECT_TRUE(slot().ruling_of(r.path()->poses()).accept);
}

TEST(TreePlanner, StartThatIsOut) {
  Task task("l_slot", {}, "slider");
  task.scene.moving[0].pose.t = {0, 0, 50};
  EXPECT_EQ(task.plan(1, {}).outcome(), Outcome::start_is_goal);
}

/// A path is found in every motion space, and rotates only where rotation is allowed.
TEST(TreePlanner, MotionSpaces) {
  TreeParameters p;
  p.motion = Motion::translation;
  const PathResult straight = slot().plan(1, kEffort, p);
  ASSERT_EQ(straight.outcome(), Outcome::solved);
  for (const auto& instant : straight.path()->poses())
    EXPECT_TRUE(instant[0].q.isApprox(Eigen::Quaterniond::Identity(), 0));
  const Task peg("peg_in_hole", {{"clearance", 0.5}, {"length", 10.0}, {"segments", std::int64_t{16}}}, "peg");
  p.motion = Motion::rotation;
  EXPECT_EQ(peg.plan(1, kEffort, p).outcome(), Outcome::solved);
}

/// The nearest exit is the nearest separated state.
TEST(TreePlanner, ExitsLeadOut) {
  Rng rng(1);
  const fake::RuleChecker checker = fake::accept_all();
  const PathQuery query{slot().assembly, slot().simulator, *slot().prepared, slot().scene, {}, 0.01, checker};
  RunContext context;
  CheckBudget budget(query, context);
  SamplingProblem problem(query, MotionSpace::rigid, 0.004, 0.01, budget);
  for (int i = 0; i < 50; ++i) {
    SamplingProblem::StateType s;
    problem.space().draw(rng, s);
    const auto order = exits_by_distance(problem, s);
    double last = 0;
    for (const int side : order) {
      const auto exit = problem.exit(s, side);
      EXPECT_TRUE(problem.is_separated(exit));
      EXPECT_TRUE(exit.turn.isApprox(s.turn, 0));
      EXPECT_GE(problem.space().distance(s, exit), last);
      last = problem.space().distance(s, exit);
    }
  }
}

}  // namespace
}  // namespace dismantle::sampling
