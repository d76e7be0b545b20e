// The planner on boxes and prisms with known answers, with a path planner that never finds anything.
#include "ndbg/ndbg.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "dismantle/testing/fake_planning.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {
namespace {

RunResult take_apart(
    const Assembly& assembly, const NdbgParameters& params = {}, unsigned threads = 1,
    fake::Script planner = [](const PathQuery&, RunContext&) { return fake::outcome(Outcome::exhausted); }) {
  RunContext context;
  context.threads = threads;
  RunOptions options;
  RunResult r = run(assembly, fake::setup(std::move(planner), std::make_shared<Ndbg>(params)), options, context);
  const PlanCheck check = check_plan(r.plan, assembly, options.verify, context, {});
  EXPECT_TRUE(check.valid) << (check.problems.empty() ? "" : check.problems.front().message);
  return r;
}

/// A bar of square section in a square tube, mapped by `map`.
Assembly bar_in_tube(const Eigen::Matrix3d& map) {
  Assembly a = fake::assembly_of(
      {{"tube",
        {{{-2, -2, -3}, {-1, 2, 3}}, {{1, -2, -3}, {2, 2, 3}}, {{-1, -2, -3}, {1, -1, 3}}, {{-1, 1, -3}, {1, 2, 3}}}},
       {"bar", {{{-1, -1, -3}, {1, 1, 3}}}}});
  for (Part& part : a.parts) {
    auto mesh = std::make_shared<Mesh>(*part.mesh);
    for (auto& v : mesh->vertices) v = map * v;
    part.mesh = part.surface = mesh;
  }
  return a;
}

Eigen::Matrix3d random_rotation(Rng& rng) {
  return Eigen::Quaterniond(rng.normal(), rng.normal(), rng.normal(), rng.normal()).normalized().toRotationMatrix();
}

TEST(Ndbg, TakesAPileFromTheTop) {
  for (const unsigned n : {1U, 4U, 7U}) {
    const RunResult r = take_apart(fake::tube_with_blocks(n));
    EXPECT_EQ(r.outcome, Outcome::solved);
    EXPECT_EQ(r.counts.attempts, 0u) << "graphs alone";
    for (unsigned k = 0; k < n; ++k) EXPECT_EQ(r.plan.disassembly[k].separates[0][0], "block" + std::to_string(n - k));
  }
}

TEST(Ndbg, FindsTheDirectionHoweverTheAssemblyIsTurned) {
  Rng rng(1);
  for (int trial = 0; trial < 20; ++trial) {
    const RunResult r = take_apart(bar_in_tube(random_rotation(rng)));
    EXPECT_EQ(r.outcome, Outcome::solved);
    EXPECT_EQ(r.plan.disassembly.size(), 1u);
  }
}

/// A slanting tube: the bar leaves along no face normal, but along a direction where two circles cross.
TEST(Ndbg, FindsWhatOnlyTheArrangementHas) {
  Rng rng(2);
  for (int trial = 0; trial < 12; ++trial) {
    Eigen::Matrix3d slant = Eigen::Matrix3d::Identity();
    slant(0, 2) = rng.uniform(0.4, 0.9);
    slant(1, 2) = rng.uniform(-0.9, -0.4);
    const Assembly assembly = bar_in_tube(random_rotation(rng) * slant);
    NdbgParameters params;
    params.circles = 0;
    EXPECT_EQ(take_apart(assembly, params).outcome, Outcome::exhausted);
    params.circles = NdbgParameters{}.circles;
    params.cells = NdbgCells::vertices;
    EXPECT_EQ(take_apart(assembly, params).outcome, Outcome::solved);
  }
}

/// More kinds of cells, more directions, each with its opposite beside it.
TEST(Ndbg, DirectionsComeInOppositePairs) {
  Rng rng(3);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::Vector3d size(rng.uniform(0.5, 2), rng.uniform(0.5, 2), rng.uniform(0.5, 2));
    const Assembly assembly = bar_in_tube(size.asDiagonal());
    std::size_t last = ndbg::directions_of(assembly, 0, NdbgCells::faces).all.size();
    for (const NdbgCells cells : {NdbgCells::vertices, NdbgCells::arcs, NdbgCells::faces}) {
      const blocking::Directions more = ndbg::directions_of(assembly, 6, cells);
      EXPECT_GE(more.all.size(), last);
      last = more.all.size();
      for (std::size_t k = 0; k < more.all.size(); ++k)
        EXPECT_LT((more.all[k] + more.all[blocking::Directions::opposite(k)]).norm(), 1e-12);
    }
    EXPECT_EQ(last, 26u) << "three planes: 6 vertices, 12 arcs, 8 faces";
  }
}

TEST(Ndbg, KeepsTheSamePlanOnAnyNumberOfThreads) {
  const Assembly assembly = fake::tube_with_blocks(5);
  std::vector<std::string> orders;
  for (const unsigned threads : {1U, 3U}) {
    const RunResult r = take_apart(assembly, {}, threads);
    std::string order;
    for (const auto& step : r.plan.disassembly) order += step.separates[0][0] + " ";
    orders.push_back(order);
  }
  EXPECT_EQ(orders[0], orders[1]);
}

TEST(Ndbg, SaysWhatNeverComesOut) {
  const RunResult r = take_apart(fake::closed_box());
  EXPECT_EQ(r.outcome, Outcome::exhausted);
  EXPECT_TRUE(r.plan.disassembly.empty());
  EXPECT_EQ(r.plan.unsolved.size(), 2u);
  EXPECT_EQ(r.counts.attempts, 0u);
}

TEST(Ndbg, AsksThePathPlannerOnlyWhereItIsTold) {
  NdbgParameters params;
  params.searches = true;
  EXPECT_GT(take_apart(fake::closed_box(), params).counts.attempts, 0u);
  EXPECT_EQ(take_apart(fake::tube_with_blocks(3), params).counts.attempts, 0u);
}

TEST(Ndbg, ParametersAreDeclaredInFull) { EXPECT_TRUE(problems_of_schema(Schema<NdbgParameters>().specs()).empty()); }

}  // namespace
}  // namespace dismantle
