// Laws of a portfolio, with members that follow a script, on many random portfolios.
#include <gtest/gtest.h>

#include <algorithm>

#include "scripted_members.h"

namespace dismantle::portfolio {
namespace {

TEST(Portfolio, SolvesWhereOneMemberDoes) {
  Rng rng(1);
  int solved = 0;
  for (int round = 0; round < 300; ++round) {
    Set set;
    fill_at_random(set, rng);
    const bool any = std::any_of(set.scripts.begin(), set.scripts.end(), [](const Script& s) { return s.solves; });
    const PathResult r = set.run();
    ASSERT_EQ(r.outcome() == Outcome::solved, any) << round;
    solved += any ? 1 : 0;
    if (any) {
      const auto by = static_cast<std::size_t>(r.path()->poses().back()[0].t.z() - 1);
      EXPECT_TRUE(set.scripts[by].solves);
      EXPECT_EQ(set.log.runs.back().first, by) << "the search ends with it";
    } else {
      EXPECT_EQ(set.status, SearchStatus::exhausted);
      for (std::size_t k = 0; k < set.scripts.size(); ++k)
        EXPECT_EQ(set.spent(k), set.scripts[k].work) << "only when all are";
      EXPECT_EQ(r.outcome(), set.scripts[0].used_up ? Outcome::depth_limit : Outcome::exhausted)
          << "what the first says";
      EXPECT_EQ(r.message, "member 0");
    }
  }
  EXPECT_GT(solved, 50);
  EXPECT_LT(solved, 250);
}

TEST(Portfolio, OfOneEqualsThatPlanner) {
  Rng rng(2);
  for (int round = 0; round < 100; ++round) {
    Set set;
    set.parameters.mode = round % 2 == 0 ? Mode::fallback : Mode::alternate;
    set.budget.max_steps = rng.below(2) == 0 ? 0 : 1 + rng.below(400);
    set.budget.max_depth = static_cast<unsigned>(rng.below(3));
    set.add(random_script(rng));
    const PathResult r = set.run();
    ASSERT_EQ(set.log.runs.size(), 1u) << "in one portion";
    Log log;
    Scripted alone(0, set.scripts[0], log);
    const PathQuery query{set.assembly, set.physics, set.prepared, {{{1, Pose{}}}, {{0, Pose{}}}},
                          set.budget,   0.01,        set.checker};
    RunContext context;
    const PathResult own = plan_path(alone, query, context);
    EXPECT_EQ(r.outcome(), own.outcome());
    EXPECT_EQ(r.stats.steps, own.stats.steps);
    EXPECT_EQ(r.stats.cost, own.stats.cost);
    EXPECT_EQ(r.message, own.message);
  }
}

TEST(Portfolio, KeepsToItsBudget) {
  Rng rng(3);
  int timeouts = 0;
  for (int round = 0; round < 300; ++round) {
    Set set;
    fill_at_random(set, rng);
    set.budget.max_steps = 1 + rng.below(500);
    const PathResult r = set.run();
    EXPECT_LE(r.stats.steps, set.budget.max_steps);
    if (r.outcome() != Outcome::timeout) continue;
    ++timeouts;
    EXPECT_EQ(r.stats.steps, set.budget.max_steps) << "all of it was used";
    EXPECT_EQ(set.status, SearchStatus::failed);
  }
  EXPECT_GT(timeouts, 50);
}

TEST(Portfolio, PortionsChangeNothing) {
  Rng rng(4);
  for (int round = 0; round < 200; ++round) {
    Set set;
    fill_at_random(set, rng);
    if (rng.below(2) == 0) set.budget.max_steps = 1 + rng.below(500);
    const PathResult whole = set.run();
    std::vector<std::uint64_t> spent;
    for (std::size_t k = 0; k < set.scripts.size(); ++k) spent.push_back(set.spent(k));
    const PathResult pieces = set.run(1 + rng.below(40));
    EXPECT_EQ(pieces.outcome(), whole.outcome());
    EXPECT_EQ(pieces.stats, whole.stats);
    for (std::size_t k = 0; k < set.scripts.size(); ++k) EXPECT_EQ(set.spent(k), spent[k]) << "member " << k;
  }
}

TEST(Portfolio, PortionsOfTimeChangeNothingAndEndInTheMiddleOfATurn) {
  Rng rng(6);
  for (int round = 0; round < 50; ++round) {
    Set set;
    fill_at_random(set, rng);
    const PathResult whole = set.run();
    std::uint64_t spent = 0;
    for (std::size_t k = 0; k < set.scripts.size(); ++k) spent += set.spent(k);
    const PathResult pieces = set.run(Budget{.timeout = 1e-5});
    EXPECT_EQ(pieces.outcome(), whole.outcome());
    EXPECT_EQ(pieces.stats, whole.stats);
    EXPECT_GE(set.portions, spent) << "one step each";
  }
}

TEST(Portfolio, FallbackRunsOneAfterTheOther) {
  Rng rng(5);
  for (int round = 0; round < 50; ++round) {
    Set set;
    fill_at_random(set, rng);
    set.parameters.mode = Mode::fallback;
    set.run();
    for (std::size_t k = 0; k < set.log.runs.size(); ++k) {
      EXPECT_EQ(set.log.runs[k].first, k);
      EXPECT_EQ(set.log.runs[k].second, set.scripts[k].work);
    }
  }
}

TEST(Portfolio, TurnsGrow) {
  Set set;
  set.parameters.turn = 10;
  set.parameters.growth = 2;
  set.add({.work = 1000});
  set.add({.work = 45, .used_up = true}, {.after = 25});
  set.add({.work = 30}, {.whole = true});
  set.run();
  using Runs = std::vector<std::pair<std::size_t, std::uint64_t>>;
  // The second member begins in the round in which the first has spent 25. At the end only the first is left.
  EXPECT_EQ(set.log.runs, (Runs{{0, 10}, {2, 30}, {0, 20}, {1, 20}, {0, 40}, {1, 25}, {0, 930}}));
}

TEST(Portfolio, WhenMembersTakePart) {
  const auto run_by = [](const Member& member, unsigned depth, std::uint64_t refused = 0, bool exhausted = true) {
    Set set;
    set.budget.max_depth = depth;
    set.add({.work = 10, .used_up = !exhausted, .refused = refused});
    set.add({.work = 10}, member);
    set.run();
    return set.log.runs.size() == 2 ? static_cast<int>(set.log.depths.back()) : -1;  // the depth that it was given
  };
  EXPECT_EQ(run_by({}, 2), 2);
  EXPECT_EQ(run_by({.depth_limited = false}, 2), -1);
  EXPECT_EQ(run_by({.depth_limited = false}, 0), 0);
  EXPECT_EQ(run_by({.least_depth = 3}, 2), -1);
  EXPECT_EQ(run_by({.least_depth = 3}, 3), 3);
  EXPECT_EQ(run_by({.least_depth = 3}, 0), 0);
  // The block is about 0.4 times as large as the tube.
  EXPECT_EQ(run_by({.least_depth = 1, .least_depth_large = 3, .large = 0.2}, 2), -1);
  EXPECT_EQ(run_by({.least_depth = 1, .least_depth_large = 3, .large = 0.9}, 2), 2);
  EXPECT_EQ(run_by({.large = 0.2, .size = Size::small}, 0), -1);
  EXPECT_EQ(run_by({.large = 0.2, .size = Size::large}, 0), 0);
  EXPECT_EQ(run_by({.large = 0.9, .size = Size::small}, 0), 0);
  EXPECT_EQ(run_by({.large = 0.9, .size = Size::large}, 0), -1);
  // `when_refused` requires that the first member is exhausted and that the verifier has refused paths of it.
  EXPECT_EQ(run_by({.least_depth = 3, .when_refused = true}, 2, 0), -1);
  EXPECT_EQ(run_by({.least_depth = 3, .when_refused = true}, 2, 1), 0);
  EXPECT_EQ(run_by({.least_depth = 3, .when_refused = true}, 2, 1, false), -1);
  EXPECT_EQ(run_by({.least_depth = 3, .when_refused = true}, 4, 0), 4);
}

TEST(Portfolio, AMemberIsGivenUpAfterItsShare) {
  for (const bool share : {false, true}) {
    Set set;
    set.parameters.mode = Mode::fallback;
    set.budget.max_steps = 1000;
    Member first;
    if (share) {
      first.share = 0.25;
    } else {
      first.max_steps = 250;
    }
    set.add({.work = 5000}, first);
    set.add({.work = 300, .solves = true});
    EXPECT_EQ(set.run().outcome(), Outcome::solved);
    EXPECT_EQ(set.spent(0), 250u);
  }
}

TEST(Portfolio, AFinalMemberEndsItWhereNothingIsLeft) {
  for (const bool used_up : {false, true}) {
    Set set;
    set.parameters.mode = Mode::fallback;
    set.add({.work = 10});
    set.add({.work = 10, .used_up = used_up}, {.final = true});
    set.add({.work = 10, .solves = true});
    EXPECT_EQ(set.run().outcome(), used_up ? Outcome::solved : Outcome::exhausted);
  }
}

TEST(Portfolio, OnlyThoseThatMovePartsIndependentlyAreAskedTo) {
  Set set;
  set.add({.work = 10, .traits = {.concurrent = true}});
  set.add({.work = 10, .solves = true});
  std::vector<std::shared_ptr<PathPlanner>> planners;
  for (std::size_t k = 0; k < 2; ++k) planners.push_back(std::make_shared<Scripted>(k, set.scripts[k], set.log));
  const PathQuery query{set.assembly, set.physics, set.prepared, {{{1, Pose{}}}, {{0, Pose{}}}},
                        {},           0.01,        set.checker,  {.any_of = {1}}};
  PortfolioSearch search(set.parameters, planners, query, set.context);
  EXPECT_EQ(search.run({}), SearchStatus::solved);
  EXPECT_EQ(set.spent(0), 0u);
}

TEST(Portfolio, EachMemberResumesWhereItHadStopped) {
  Rng rng(6);
  for (int round = 0; round < 50; ++round) {
    Set set;
    fill_at_random(set, rng);
    for (Script& s : set.scripts) s.solves = false;
    set.budget.max_steps = 1 + rng.below(300);
    const PathResult first = set.run();
    ASSERT_NE(first.state, nullptr);
    std::vector<std::uint64_t> before;
    for (std::size_t k = 0; k < set.scripts.size(); ++k) before.push_back(set.spent(k));
    set.budget.max_steps = 0;
    set.resume_from = first.state;
    set.run();
    for (std::size_t k = 0; k < set.scripts.size(); ++k) EXPECT_EQ(before[k] + set.spent(k), set.scripts[k].work);
  }
}

/// The result is the same whether or not a thread was idle.
TEST(Portfolio, TheSameWithIdleThreads) {
  Rng rng(7);
  for (int round = 0; round < 100; ++round) {
    Set set;
    set.budget.max_depth = 3;
    for (auto n = 2 + rng.below(3); n > 0; --n) {
      Script script = random_script(rng);
      script.work *= 50;
      script.refused = rng.below(2);
      set.add(script, {.first = rng.below(3) == 0, .when_refused = rng.below(3) == 0});
    }
    const PathResult alone = set.run();
    set.executor = std::make_shared<Executor>(3);
    const PathResult helped = set.run();
    EXPECT_EQ(helped.outcome(), alone.outcome());
    EXPECT_EQ(helped.stats, alone.stats);
    EXPECT_EQ(helped.message, alone.message);
    ASSERT_EQ(helped.path().has_value(), alone.path().has_value());
    if (alone.path()) {
      EXPECT_EQ(helped.path()->poses().back()[0].t, alone.path()->poses().back()[0].t);
    }
  }
}

TEST(Portfolio, CancelledSearchesEnd) {
  for (const Mode mode : {Mode::fallback, Mode::alternate}) {
    Set set;
    set.parameters.mode = mode;
    set.add({.work = 100});
    set.add({.work = 100});
    set.context.cancel.cancel();
    EXPECT_EQ(set.run().outcome(), Outcome::cancelled);
    EXPECT_EQ(set.log.runs.size(), 1u);
  }
}

}  // namespace
}  // namespace dismantle::portfolio
