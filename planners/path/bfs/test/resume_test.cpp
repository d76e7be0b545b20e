// Searches that resume from an earlier search with more parts in the way.
#include <algorithm>

#include "random_maze.h"

namespace dismantle::push::test {
namespace {

ParamSet translating() { return {{"motion", std::string("translation")}}; }

struct Made {
  MazeRun run;
  Made(const RandomMaze& m, const char* planner, unsigned depth, const std::vector<PartId>& closed,
       const SearchState* reached = nullptr) {
    search(run, m.maze, translating(), {.max_depth = depth}, accept, {}, 1, {true, true, true, 4}, planner, {}, closed,
           reached);
  }
};

/// The blocking parts leave one after the other. A resumed search finds what a search from the start finds, and
/// simulates less by the steps it was spared.
TEST(Resume, FindsWhatASearchFromTheStartFindsWithLessSimulation) {
  for (const char* planner : {"bfs", "contact_search"})
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      SCOPED_TRACE(std::string(planner) + ", seed " + std::to_string(seed));
      const RandomMaze m = random_maze(seed);
      const Made first(m, planner, 0, {kNear, kFar});
      ASSERT_EQ(first.run.result.outcome(), Outcome::exhausted) << "or it is no test";
      ASSERT_NE(first.run.result.state, nullptr);
      const Made second(m, planner, 0, {kFar}, first.run.result.state.get()), second_anew(m, planner, 0, {kFar});
      ASSERT_EQ(second_anew.run.result.outcome(), Outcome::exhausted);
      EXPECT_EQ(second.run.result.outcome(), Outcome::exhausted);
      const auto far = [](const PathResult& r) { return r.best_pose.at(0).t.sum(); };
      EXPECT_GT(far(second_anew.run.result), far(first.run.result)) << "the gate was in the way";
      EXPECT_NEAR(far(second.run.result), far(second_anew.run.result), 0.3);
      EXPECT_EQ(second.run.result.blocked_by, second_anew.run.result.blocked_by)
          << "those that were touched before, too";
      const Made third(m, planner, 0, {}, second.run.result.state.get()), third_anew(m, planner, 0, {});
      ASSERT_EQ(third_anew.run.result.outcome(), Outcome::solved);
      EXPECT_EQ(third.run.result.outcome(), Outcome::solved);
      EXPECT_EQ(third.run.result.path()->poses().front()[0].t, Vector3d::Zero());
      EXPECT_GT(third.run.result.stats.resumed_nodes, 0u);
      EXPECT_GT(third.run.result.stats.spared, 0u);
      EXPECT_LT(third.run.notes.steps, third_anew.run.notes.steps);
      EXPECT_EQ(third.run.result.state, nullptr);
    }
}

/// With only the depth limit raised, resumed searches reach as far as one from the start, with hardly more simulation.
TEST(Resume, GoesDeeperWithoutDoingThingsTwice) {
  for (const char* planner : {"bfs", "contact_search"})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE(std::string(planner) + ", seed " + std::to_string(seed));
      const RandomMaze m = random_maze(seed);
      std::shared_ptr<const SearchState> reached;
      std::uint64_t steps = 0, steps_anew = 0;
      for (unsigned depth = 1; depth <= m.bends + 1; ++depth) {
        const Made on(m, planner, depth, {}, reached.get()), anew(m, planner, depth, {});
        EXPECT_EQ(on.run.result.outcome(), anew.run.result.outcome()) << "depth " << depth;
        reached = on.run.result.state;
        steps += on.run.notes.steps;
        steps_anew = anew.run.notes.steps;
        if (is_success(anew.run.result.outcome())) break;
      }
      EXPECT_LT(steps, 1.2 * static_cast<double>(steps_anew));
    }
}

/// A search in portions ends like a search without portions; interrupted work is repeated.
TEST(Resume, InPortionsAsInOneGo) {
  int cut = 0;
  for (const bool open : {true, false})
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      SCOPED_TRACE(seed);
      const RandomMaze m = random_maze(seed);
      const std::vector<PartId> closed = open ? std::vector<PartId>{} : std::vector<PartId>{kFar};
      const ParamSet few{
          {"motion", std::string("translation")}, {"diagonals", false}, {"intermediate", std::int64_t{0}}};
      MazeRun whole;
      search(whole, m.maze, few, {}, accept, {}, 1, {true, true, true, 4}, "bfs", {}, closed);
      std::shared_ptr<const SearchState> reached;
      Outcome end = Outcome::timeout;
      int portions = 0;
      std::uint64_t nodes = 0;
      for (; end == Outcome::timeout && portions < 2000; ++portions) {
        MazeRun run;
        search(run, m.maze, few, {.max_steps = 550 + 37 * seed}, accept, {}, 1, {true, true, true, 4}, "bfs", {},
               closed, reached.get());
        reached = run.result.state;
        end = run.result.outcome();
        nodes = run.result.stats.nodes;
      }
      cut += portions > 1 ? 1 : 0;
      EXPECT_EQ(end, whole.result.outcome());
      if (!open) {
        EXPECT_EQ(nodes, whole.result.stats.nodes);
      }
    }
  EXPECT_GT(cut, 20);
}

/// With a limit of states, known states count in it, but at least half of it is for new states.
TEST(Resume, HalfOfABudgetIsForWhatIsNew) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const RandomMaze m = random_maze(seed);
    const auto plan = [&](unsigned depth, const SearchState* reached) {
      MazeRun run;
      search(run, m.maze,
             {{"motion", std::string("auto")},
              {"translation_nodes", std::int64_t{1}},
              {"rotation_nodes", std::int64_t{1}}},
             {.max_depth = depth}, accept, {}, 1, {true, true, true, 4}, "bfs", {}, {kFar}, reached);
      return run.result;
    };
    const PathResult first = plan(6, nullptr), again = plan(6, first.state.get()), more = plan(6, again.state.get()),
                     fixed_more = plan(6, more.state.get());
    EXPECT_EQ(first.stats.extra.at("expanded"), 6 + 6);
    EXPECT_EQ(again.stats.extra.at("expanded"), 3 + 3);
    EXPECT_EQ(more.stats.extra.at("expanded"), 3 + 3);
    EXPECT_EQ(fixed_more.stats.extra.at("expanded"), 3 + 3) << "however much is known";
  }
}

/// If no part has left and the depth is the same, nothing is simulated.
TEST(Resume, WhereNothingHasChangedNothingIsSimulated) {
  const RandomMaze m = random_maze(3);
  const Made first(m, "bfs", 0, {kFar});
  ASSERT_EQ(first.run.result.outcome(), Outcome::exhausted);
  const Made again(m, "bfs", 0, {kFar}, first.run.result.state.get());
  EXPECT_EQ(again.run.result.outcome(), Outcome::exhausted);
  EXPECT_EQ(again.run.notes.steps, 0U);
  EXPECT_EQ(again.run.result.blocked_by, first.run.result.blocked_by);
}

/// A known state is separated after the last part around it has left. It is verified without any action.
TEST(Resume, WhatIsOutNowIsJudgedAtOnce) {
  const RandomMaze m = random_maze(5);
  const Made first(m, "bfs", 0, {kFar});
  ASSERT_EQ(first.run.result.outcome(), Outcome::exhausted);
  RandomMaze open = m;
  open.maze.exit = Aabb{Vector3d::Constant(-0.2), Vector3d::Constant(0.2)};
  const Made again(open, "bfs", 0, {}, first.run.result.state.get());
  EXPECT_EQ(again.run.result.outcome(), Outcome::solved);
  EXPECT_EQ(again.run.notes.steps, 0U);
  ASSERT_GE(again.run.result.path()->poses().size(), 2U);
  EXPECT_GE(again.run.result.depth, 1U);
}

/// If the start itself is separated, no action is needed either.
TEST(Resume, WhoIsOutAtTheStartHasNothingToDo) {
  const RandomMaze m = random_maze(5);
  const Made first(m, "bfs", 0, {kFar});
  RandomMaze open = m;
  open.maze.exit = Aabb{Vector3d::Constant(7), Vector3d::Constant(8)};
  const Made again(open, "bfs", 0, {}, first.run.result.state.get());
  EXPECT_EQ(again.run.result.outcome(), Outcome::start_is_goal);
}

/// Contact samples are kept unless they belong to a part that has left.
TEST(Resume, ContactSamplesAreKept) {
  for (const bool about_gate : {false, true}) {
    const RandomMaze m = random_maze(4);
    Maze leaky = m.maze;
    leaky.free.push_back(tunnel(Vector3d::Zero(), -12 * Vector3d::UnitX()));
    leaky.free_after_learning = m.maze.free;
    const Rule refuse_the_leak = [about_gate](const Path& path) {
      Ruling v;
      v.accept = path.back()[0].t.x() > 0;
      if (!v.accept) v.has_witness = true, v.part = 0, v.other = about_gate ? kFar : 9;
      return v;
    };
    MazeRun first, again;
    search(first, leaky, translating(), {}, refuse_the_leak, {}, 1, {true, true, true, 4}, "bfs", {}, {kFar});
    ASSERT_EQ(first.result.outcome(), Outcome::exhausted);
    ASSERT_EQ(first.checked.size(), 1U);
    search(again, leaky, translating(), {}, refuse_the_leak, {}, 1, {true, true, true, 4}, "bfs", {}, {},
           first.result.state.get());
    EXPECT_EQ(again.result.outcome(), Outcome::solved);
    EXPECT_EQ(again.notes.learned, about_gate ? again.checked.size() - 1 : 1U);
  }
}

/// The search states of other planners are ignored.
TEST(Resume, WhatIsNotItsOwnIsIgnored) {
  class Strange final : public SearchState {};
  const Strange strange;
  const RandomMaze m = random_maze(2);
  const Made with(m, "bfs", 0, {}, &strange), without(m, "bfs", 0, {});
  EXPECT_EQ(with.run.result.outcome(), Outcome::solved);
  EXPECT_EQ(with.run.result.stats, without.run.result.stats);
}

}  // namespace
}  // namespace dismantle::push::test
