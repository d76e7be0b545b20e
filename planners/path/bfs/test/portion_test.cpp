// Searches that run in portions, between which the caller may prove that there is no path.
#include <algorithm>

#include "random_maze.h"

namespace dismantle::push::test {
namespace {

/// The largest cost of one call of run() with `portion`, in a maze with closed gates, up to a total cost of `most`.
double largest_call(const RandomMaze& m, const char* planner, std::uint64_t portion, double most) {
  Notes notes;
  MazeSimulator simulator(m.maze, notes);
  const Assembly assembly;
  RunContext context;
  const auto prepared = simulator.prepare(assembly, 0.01, context);
  const Scene scene{{{0, Pose{}}}, {{9, Pose{}}, {kNear, Pose{}}, {kFar, Pose{}}}};
  const fake::RuleChecker checker(accept);
  const PathQuery query{assembly, simulator, *prepared, scene, {}, 0.01, checker, {}, nullptr};
  const auto path_planner = registry().create<PathPlanner>(planner, {});
  const auto search = path_planner->start(query, context);
  double before = 0, largest = 0;
  while (before < most && search->run({.max_steps = portion}) == SearchStatus::paused) {
    const double now = search->result().stats.cost;
    largest = std::max(largest, now - before);
    before = now;
  }
  return largest;
}

/// A call costs at most its portion plus the actions of one state of either search. Translation and rotation take turns
/// and share the portion.
TEST(Portions, EndWhereTheyAreUsed) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const RandomMaze m = random_maze(seed);
    for (const char* planner : {"bfs", "contact_search"}) {
      constexpr double kMost = 20000;
      const double one_state = largest_call(m, planner, 1, kMost);
      ASSERT_GT(one_state, 0);
      for (const double states : {5.0, 8.0})
        EXPECT_LE(largest_call(m, planner, static_cast<std::uint64_t>(states * one_state), kMost),
                  (states + 2) * one_state)
            << planner << ", seed " << seed << ", " << states << " states";
    }
  }
}

}  // namespace
}  // namespace dismantle::push::test
