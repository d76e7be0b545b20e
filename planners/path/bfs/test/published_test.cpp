// Algorithm 1 as published, with the paper's configuration: paths found and simulated steps needed.
#include <gtest/gtest.h>

#include <string>

#include "dismantle/run_context.h"
#include "table.h"

namespace dismantle::bfs {
namespace {

using Eigen::Vector3d;
using path::test::assembly_of;
using path::test::block;
using path::test::boxes;

/// Plugin sections of configs/paper.yaml.
ParamSet paper_simulator(bool adaptive = true) {
  return {{"dynamics", std::string("acceleration")},
          {"adaptive", adaptive},
          {"max_travel", 0.06},
          {"rest_share", 0.01},
          {"contact_threshold", 0.005}};
}
ParamSet paper_planner(ParamSet given = {}) {
  given.insert({{"variant", std::string("published")},
                {"torque", 300.0},
                {"similarity_rotation", 1.0},
                {"diagonals", false},
                {"intermediate", std::int64_t{0}}});
  return given;
}

struct PublishedBench : path::test::Table {
  explicit PublishedBench(Assembly a, bool adaptive = true) : Table(std::move(a)) {
    simulator = path::test::registry().create<Simulator>("sdf_penalty", paper_simulator(adaptive));
    RunContext context;
    prepared = simulator->prepare(assembly, 0.01, context);
  }
  PathResult plan(const ParamSet& given, const Budget& effort = {}, const SearchState* resume_from = nullptr) {
    return Table::plan("bfs", paper_planner(given), 0, effort, {0}, {}, resume_from);
  }
};

/// A slider in a roofed slot. It leaves `length` along +x, then up through a hole.
Assembly slot(double length, const Pose& pose = {}) {
  const double c = 0.02, end = length + 1;
  return assembly_of({boxes({block(0, 0, 0, 1, 0.8, 0.6)}),
                      boxes({block(-0.5, -0.5, -0.5, end + 0.5, 1.3, -c),  // floor
                             block(-0.5, -0.5, -c, -c, 1.3, 1), block(end + c, -0.5, -c, end + 0.5, 1.3, 1),
                             block(-c, -0.5, -c, end + c, -c, 1), block(-c, 0.8 + c, -c, end + c, 1.3, 1),
                             block(-c, -c, 0.6 + c, length - c, 0.8 + c, 1)})},  // roof
                     pose);
}

const ParamSet kTranslationOnly{{"motion", std::string("translation")}};

TEST(Published, SlotsOfAnyLengthAreSolvedAtDepthTwoInFewSteps) {
  Rng rng(1);
  for (int k = 0; k < 6; ++k) {
    const double length = rng.uniform(1.2, 4);
    PublishedBench bench(slot(length));
    const PathResult r = bench.plan(kTranslationOnly);
    ASSERT_EQ(r.outcome(), Outcome::solved) << length << ": " << r.message;
    EXPECT_EQ(r.depth, 2u);
    // A planning time step of 100 time steps moves it by half a unit; a tenth of the time steps is simulated.
    EXPECT_LT(r.stats.steps, 150 + 60 * length) << length;
    EXPECT_EQ(bench.plan(kTranslationOnly, {.max_depth = 1}).outcome(), Outcome::depth_limit);
  }
}

/// Parts that are pushed askew bend around the edges that guide them.
TEST(Published, PathsAreThinnedToAShareOfTheTolerance) {
  for (const double slope : {0.3, 0.6}) {
    const Pose turned{Vector3d::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(slope, Vector3d(1, 2, 3).normalized()))};
    PublishedBench bench(slot(1.5, turned));
    const PathResult r = bench.plan(kTranslationOnly);
    ASSERT_EQ(r.outcome(), Outcome::solved) << slope << ": " << r.message;
    EXPECT_EQ(r.stats.refused, 0u) << slope;
  }
}

TEST(Published, EveryTimeStepSimulatedFindsTheSameWayInTheStepsOfTheSource) {
  Rng rng(2);
  for (int k = 0; k < 3; ++k) {
    const double length = rng.uniform(1.2, 3);
    PublishedBench every(slot(length), false), adaptive(slot(length));
    const PathResult a = every.plan(kTranslationOnly), b = adaptive.plan(kTranslationOnly);
    ASSERT_EQ(a.outcome(), Outcome::solved) << a.message;
    ASSERT_EQ(b.outcome(), Outcome::solved) << b.message;
    EXPECT_EQ(a.depth, b.depth);
    // The source takes at least 2 blocks of 100 for each of six actions at the first level, and as many at the second.
    EXPECT_LT(a.stats.steps, 2400 + 200 * (length + 1) / 0.5);
    EXPECT_LT(5 * b.stats.steps, a.stats.steps + 500);
  }
}

TEST(Published, ADeeperSearchGoesOnWhereTheEarlierEnded) {
  PublishedBench bench(slot(2));
  const PathResult whole = bench.plan(kTranslationOnly, {.max_depth = 2});
  const PathResult first = bench.plan(kTranslationOnly, {.max_depth = 1});
  ASSERT_TRUE(first.state);
  const PathResult second = bench.plan(kTranslationOnly, {.max_depth = 2}, first.state.get());
  ASSERT_EQ(second.outcome(), Outcome::solved);
  EXPECT_EQ(first.stats.steps + second.stats.steps, whole.stats.steps);
  ASSERT_EQ(second.path()->poses().size(), whole.path()->poses().size());
  for (std::size_t k = 0; k < whole.path()->poses().size(); ++k)
    EXPECT_EQ(second.path()->poses()[k][0].t, whole.path()->poses()[k][0].t);
}

TEST(Published, TheLongestWayComesFirst) {
  PublishedBench bench(slot(3));
  const PathResult longest = bench.plan(kTranslationOnly);
  ParamSet queue = kTranslationOnly;
  queue["order"] = std::string("first_come");
  const PathResult first = bench.plan(queue);
  ASSERT_EQ(longest.outcome(), Outcome::solved);
  ASSERT_EQ(first.outcome(), Outcome::solved);
  EXPECT_LE(longest.stats.steps, first.stats.steps);
}

/// A room with walls all around: nothing leaves with or without rotation, and the search ends exhausted.
TEST(Published, AClosedBoxIsExhaustedWithoutARefusal) {
  const double play = 0.02, w = 0.1;
  Mesh room = boxes({block(-0.6 - w, -0.5 - w, -0.4 - w, 0.6 + w, 0.5 + w, 0.4 + w)});
  const Mesh inner = boxes({block(-0.6, -0.5, -0.4, 0.6, 0.5, 0.4)});
  for (const auto& v : inner.vertices) room.vertices.push_back(v);
  for (const auto& t : inner.triangles) room.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  PublishedBench bench(
      assembly_of({boxes({block(-0.6 + play, -0.5 + play, -0.4 + play, 0.6 - play, 0.5 - play, 0.4 - play)}), room}));
  for (const char* motion : {"translation", "rotation", "auto"}) {
    const PathResult r = bench.plan({{"motion", std::string(motion)}}, {.max_steps = 20'000});
    EXPECT_EQ(r.outcome(), Outcome::exhausted) << motion << ", " << r.stats.steps << " steps";
    EXPECT_EQ(r.stats.refused, 0u);
    EXPECT_EQ(r.blocked_by, std::vector<PartId>{1});
  }
}

TEST(Published, InPortionsTheSearchIsTheSame) {
  PublishedBench bench(slot(2));
  const PathResult whole = bench.plan({});
  ASSERT_EQ(whole.outcome(), Outcome::solved);
  const PathResult limited = bench.plan({}, {.max_steps = whole.stats.steps});
  ASSERT_EQ(limited.outcome(), Outcome::solved);
  EXPECT_EQ(limited.path()->poses().size(), whole.path()->poses().size());
  EXPECT_EQ(bench.plan({}, {.max_steps = whole.stats.steps / 2}).outcome(), Outcome::timeout);
}

}  // namespace
}  // namespace dismantle::bfs
