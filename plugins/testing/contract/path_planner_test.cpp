// Laws of the answers of all path planners.
#include <thread>

#include "dismantle/testing/fake_planning.h"
#include "path_planner_contract.h"

namespace dismantle::contract {
namespace {

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(PathPlannerContract);

TEST_P(PathPlannerContract, DeclaresItselfInFull) {
  const PluginType& type = registry().find(PluginKind::path_planner, GetParam()).type;
  EXPECT_TRUE(problems_of_schema(type.params).empty());
  EXPECT_FALSE(type.summary.empty());
  const Capabilities says = type.traits.needs, needs = make()->traits().needs;
  EXPECT_EQ(says.dynamics, needs.dynamics);
  EXPECT_EQ(says.contacts, needs.contacts);
  EXPECT_EQ(says.distance, needs.distance);
}

TEST_P(PathPlannerContract, WhatIsSolvedWasAccepted) {
  for (std::size_t which = 0; which < small_assemblies().size(); ++which) {
    Run run;
    plan(run, which);
    if (expected("solves", GetParam())) {
      EXPECT_EQ(run.result.outcome(), Outcome::solved) << small_assemblies()[which].name;
    }
  }
}

/// A concurrent planner gives on each of several threads the result that it gives alone.
TEST_P(PathPlannerContract, AConcurrentOneIsNotConfusedByOthers) {
  const auto shared = make();
  if (!shared->traits().concurrent) GTEST_SKIP() << "each thread has its own";
  const auto planned = [](PathPlanner& planner, std::size_t which) {
    const Small& small = small_assemblies()[which];
    const Scene scene = small.scene();
    const fake::RuleChecker checker([&](const Path& path) { return verify(small, scene, path); });
    const PathQuery query{small.assembly, *ready()->simulator,    *ready()->prepared[which],
                          scene,          {.max_steps = kPlenty}, kTolerance,
                          checker};
    RunContext context;
    return plan_path(planner, query, context);
  };
  const std::size_t count = small_assemblies().size();
  std::vector<PathResult> alone(count), together(2 * count);
  for (std::size_t k = 0; k < count; ++k) alone[k] = planned(*make(), k);
  {
    std::vector<std::jthread> threads;
    for (std::size_t k = 0; k < together.size(); ++k)
      threads.emplace_back([&, k] { together[k] = planned(*shared, k % count); });
  }
  for (std::size_t k = 0; k < together.size(); ++k) {
    EXPECT_EQ(together[k].outcome(), alone[k % count].outcome());
    EXPECT_TRUE(same(poses_of(together[k]), poses_of(alone[k % count])));
    EXPECT_EQ(together[k].stats, alone[k % count].stats);
  }
}

TEST_P(PathPlannerContract, ABlockedPartIsNotSolved) {
  // All parts but the lid, while the lid is on.
  const std::size_t which = 2;
  const Small& small = small_assemblies()[which];
  for (const auto& part : small.assembly.parts) {
    if (part.id == small.leaves || part.name == "box") continue;
    const Scene scene = small.cast_of({part.id});
    Run run;
    plan(run, which, {.max_depth = 1, .max_steps = 3'000}, {}, {}, &scene);
    EXPECT_FALSE(is_success(run.result.outcome())) << part.name;
  }
}

/// A plate in a closed box, with room to move and turn, for any size of the room and any seed.
TEST_P(PathPlannerContract, ABoxInAClosedBoxIsNeverSolved) {
  Rng rng(64);
  for (int trial = 0; trial < 3; ++trial) {
    const double half = rng.uniform(0.6, 1.6);  // of the plate; the room is 1.9
    const auto wall = [](double x0, double y0, double z0, double x1, double y1, double z1) {
      return fake::Box{{x0, y0, z0}, {x1, y1, z1}};
    };
    const Assembly assembly = fake::assembly_of(
        {{"box",
          {wall(-2, -2, -2, 2, 2, -1.9), wall(-2, -2, 1.9, 2, 2, 2), wall(-2, -2, -1.9, -1.9, 2, 1.9),
           wall(1.9, -2, -1.9, 2, 2, 1.9), wall(-1.9, -2, -1.9, 1.9, -1.9, 1.9), wall(-1.9, 1.9, -1.9, 1.9, 2, 1.9)}},
         {"plate", {wall(-half, -half, -0.2, half, half, 0.2)}}});
    RunContext context;
    context.rng = Rng(static_cast<std::uint64_t>(trial));
    const auto prepared = ready()->simulator->prepare(assembly, kTolerance, context);
    const Verifier verifier(assembly, VerifyOptions{});
    const Scene scene{{{1, Pose{}}}, {{0, Pose{}}}};
    const fake::RuleChecker checker([&](const Path& path) {
      fake::Ruling v = fake::ruling_of(verifier.check_motion({1}, scene.fixed, path));
      v.accept = v.accept && verifier.apart({{1, path.back()[0]}}, scene.fixed);
      return v;
    });
    const PathQuery query{assembly, *ready()->simulator, *prepared, scene, {.max_steps = 3'000}, kTolerance, checker};
    const auto planner = make();
    const PathResult result = plan_path(*planner, query, context);
    EXPECT_FALSE(is_success(result.outcome())) << "a plate of " << 2 * half << " left its box";
    EXPECT_NE(result.outcome(), Outcome::crashed) << result.message;
  }
}

/// A planner may resume an unsuccessful search from its state when a blocker has left, also in another object with the
/// same parameters. It ignores states of other planners. All laws hold as for a search from the start.
TEST_P(PathPlannerContract, GoesOnFromWhatItReachedOrBeginsAnew) {
  const std::size_t which = 2;
  const Small& small = small_assemblies()[which];
  class Strange final : public SearchState {};
  const Strange strange;
  int solved = 0;
  for (const auto& part : small.assembly.parts) {
    if (part.id == small.leaves || part.name == "box") continue;
    const Scene closed = small.cast_of({part.id});
    Scene open = closed;
    std::erase_if(open.fixed, [&](const PlacedPart& p) { return p.part == small.leaves; });
    const Budget little{.max_depth = 2, .max_steps = 1'000};
    Run first, strangers, anew, again, same_again;
    plan(first, which, little, {}, {}, &closed);
    ASSERT_FALSE(is_success(first.result.outcome())) << part.name;
    plan(strangers, which, little, {}, {}, &closed, nullptr, &strange);
    EXPECT_EQ(strangers.result.stats, first.result.stats);
    plan(anew, which, little, {}, {}, &open);
    plan(again, which, little, {}, {}, &open, nullptr, first.result.state.get());
    plan(same_again, which, little, {}, {}, &open, nullptr, first.result.state.get());
    EXPECT_EQ(again.result.outcome(), same_again.result.outcome());
    EXPECT_EQ(again.result.stats, same_again.result.stats);
    EXPECT_TRUE(same(poses_of(again.result), poses_of(same_again.result)));
    if (expected("resumes", GetParam())) {
      EXPECT_NE(first.result.state, nullptr);
      EXPECT_EQ(is_success(again.result.outcome()), is_success(anew.result.outcome())) << part.name;
      solved += is_success(again.result.outcome()) ? 1 : 0;
      EXPECT_GT(again.result.stats.resumed_nodes, 0);
    }
    if (is_success(again.result.outcome())) {
      EXPECT_EQ(again.result.state, nullptr);
    }
  }
  if (expected("resumes", GetParam())) {
    EXPECT_GT(solved, 0);
  }
}

TEST_P(PathPlannerContract, APartThatIsOutHasNothingToDo) {
  Scene scene = small_assemblies()[0].scene();
  scene.moving[0].pose.t = Vector3d(0, 0, 30);
  Run run;
  plan(run, 0, {}, {}, {}, &scene);
  EXPECT_EQ(run.result.outcome(), Outcome::start_is_goal);
  EXPECT_FALSE(run.result.path()) << "the engine fills it";
}

TEST_P(PathPlannerContract, StartsFromWhereverTheCastIs) {
  Scene scene = small_assemblies()[0].scene();
  scene.moving[0].pose.t = Vector3d(0.01, -0.005, 0.4);
  Run run;
  plan(run, 0, {.max_steps = kPlenty}, {}, {}, &scene);
  if (expected("solves", GetParam())) {
    EXPECT_EQ(run.result.outcome(), Outcome::solved);
  }
}

TEST_P(PathPlannerContract, SameSeedSameResultOnAnyObject) {
  const auto used = make();
  for (std::size_t which = 0; which < 2; ++which) {
    const auto seeded = [](std::uint64_t seed) {
      RunContext context;
      context.rng = Rng(seed);
      return context;
    };
    Run a, b;
    plan(a, which, {.max_steps = kPlenty}, seeded(7));
    plan(b, which, {.max_steps = kPlenty}, seeded(7), {}, nullptr, used.get());
    EXPECT_EQ(a.result.outcome(), b.result.outcome());
    EXPECT_TRUE(same(poses_of(a.result), poses_of(b.result)));
    EXPECT_EQ(a.result.blocked_by, b.result.blocked_by);
    EXPECT_EQ(a.counted.steps, b.counted.steps);
    EXPECT_EQ(a.checked.size(), b.checked.size());
  }
}

TEST_P(PathPlannerContract, SeveralPartsMoveAtOnce) {
  const Small& small = small_assemblies()[2];
  std::vector<PartId> all_but_box;
  for (const auto& p : small.assembly.parts)
    if (p.name != "box") all_but_box.push_back(p.id);
  ASSERT_GE(all_but_box.size(), 2u);
  if (ready()->simulator->capabilities().max_moving < all_but_box.size())
    GTEST_SKIP() << "the simulator moves fewer; the runner refuses that before";
  const Scene scene = small.cast_of(all_but_box);
  Run run;
  plan(run, 2, {.max_steps = kPlenty}, {}, {}, &scene);
}

/// A search in growing portions has the same result as in one portion.
TEST_P(PathPlannerContract, InPortionsAsAtOnce) {
  for (std::size_t which = 0; which < 2; ++which) {
    Run at_once;
    plan(at_once, which);
    const Small& small = small_assemblies()[which];
    const Scene scene = small.scene();
    const fake::RuleChecker checker([&](const Path& path) { return verify(small, scene, path); });
    const PathQuery query{small.assembly, *ready()->simulator,    *ready()->prepared[which],
                          scene,          {.max_steps = kPlenty}, kTolerance,
                          checker};
    const auto planner = make();
    RunContext context;
    const auto search = planner->start(query, context);
    SearchStatus status = SearchStatus::paused;
    for (std::uint64_t portion = 200; status == SearchStatus::paused && portion < 100 * kPlenty; portion *= 2)
      status = search->run({.max_steps = portion});
    EXPECT_NE(status, SearchStatus::paused);
    const PathResult in_portions = search->result();
    EXPECT_EQ(status, status_of(in_portions.outcome()));
    EXPECT_EQ(in_portions.outcome(), at_once.result.outcome());
    EXPECT_TRUE(same(poses_of(in_portions), poses_of(at_once.result)));
  }
}

INSTANTIATE_TEST_SUITE_P(Registered, PathPlannerContract, testing::ValuesIn(ids(PluginKind::path_planner)), test_name);

}  // namespace
}  // namespace dismantle::contract
