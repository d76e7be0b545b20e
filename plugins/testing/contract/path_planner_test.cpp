// What every path planner must obey, with its default parameters, on the first simulator that has what it needs.
#include <functional>
#include <thread>

#include "counting_simulator.h"
#include "small_assemblies.h"

namespace dismantle {
namespace {

using namespace contract;

bool covers(const Capabilities& has, const Capabilities& needs) {
  return (has.dynamics || !needs.dynamics) && (has.contacts || !needs.contacts) && (has.distance || !needs.distance);
}

bool same(const Path& a, const Path& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k].size() != b[k].size()) return false;
    for (std::size_t i = 0; i < a[k].size(); ++i)
      if (!bitwise(a[k][i], b[k][i])) return false;
  }
  return true;
}

/// Empty where nothing was found.
Path poses_of(const PathResult& result) { return result.path() ? result.path()->poses() : Path{}; }

/// Doc of PathPlanner: cancellation and budgets are looked at at least so often.
constexpr std::uint64_t kLook = 100;
/// Enough for any of the small assemblies.
constexpr std::uint64_t kPlenty = 30'000;

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(PathPlannerContract);


class PathPlannerContract : public testing::TestWithParam<std::string> {
 protected:
  struct Ready {
    std::shared_ptr<Simulator> simulator;
    std::vector<std::shared_ptr<const Prepared>> prepared;  ///< as small_assemblies()
  };
  struct Run {
    PathResult result;
    std::vector<std::pair<Path, bool>> judged;  ///< and whether it was accepted
    Counted counted;
    std::string output;
  };
  using Rule = std::function<fake::Ruling(const Path&)>;

  static std::shared_ptr<PathPlanner> make() { return registry().create<PathPlanner>(GetParam()); }
  /// The simulator and what it prepared, once for all tests; null when there is none.
  static const Ready* ready() {
    static std::map<std::string, Ready> cache;
    const Capabilities needs = make()->traits().needs;
    auto candidates = registry().types(PluginKind::simulator);  // this project's first: a third party's id has a dot
    std::stable_partition(candidates.begin(), candidates.end(),
                          [](const RegisteredType* t) { return t->type.id.find('.') == std::string::npos; });
    for (const RegisteredType* candidate : candidates) {
      const std::string& id = candidate->type.id;
      if (cache.contains(id)) {
        if (covers(cache.at(id).simulator->capabilities(), needs)) return &cache.at(id);
        continue;
      }
      auto simulator = registry().create<Simulator>(id);
      if (!covers(simulator->capabilities(), needs)) continue;
      Ready& r = cache[id];
      r.simulator = simulator;
      for (const auto& small : small_assemblies()) {
        RunContext context;
        r.prepared.push_back(simulator->prepare(small.assembly, 0.01, context));
      }
      return &r;
    }
    return nullptr;
  }

  static fake::Ruling verify(const Small& small, const Cast& cast, const Path& path) {
    std::vector<PartId> moving;
    std::vector<PlacedPart> group = cast.moving;
    for (std::size_t i = 0; i < group.size(); ++i) {
      moving.push_back(group[i].part);
      group[i].pose = path.back()[i];
    }
    const MotionCheck check = small.verifier->check_motion(moving, cast.still, path);
    fake::Ruling v = fake::ruling_of(check);
    v.accept = v.accept && small.verifier->apart(group, cast.still);
    if (v.has_witness) v.reason = "it cuts";
    return v;
  }

  /// One search; a rule that is empty is the verifier.
  static void plan(Run& run, std::size_t which, const Budget& effort = {.max_steps = kPlenty}, RunContext context = {},
                   const Rule& rule = {}, const Cast* cast = nullptr, PathPlanner* planner = nullptr,
                   const SearchState* resume_from = nullptr) {
    const Small& small = small_assemblies()[which];
    CountingSimulator simulator(ready()->simulator, run.counted);
    const Cast chosen = cast != nullptr ? *cast : small.cast();
    const fake::RuleChecker checker([&](const Path& path) {
      const fake::Ruling ruling = rule ? rule(path) : verify(small, chosen, path);
      run.judged.emplace_back(path, ruling.accept);
      return ruling;
    });
    const PathQuery query{small.assembly, simulator, *ready()->prepared[which], chosen, effort, 0.01, checker, {},
                          resume_from};
    const auto own = make();
    testing::internal::CaptureStdout();
    run.result = plan_path(planner != nullptr ? *planner : *own, query, context);
    run.output = testing::internal::GetCapturedStdout();
    expect_lawful(run, small, chosen, effort);
  }

  /// What holds however a search ends.
  static void expect_lawful(const Run& run, const Small& small, const Cast& cast, const Budget& effort) {
    SCOPED_TRACE(small.name);
    const PathResult& r = run.result;
    EXPECT_TRUE(run.output.empty()) << "planners never print: " << run.output;
    EXPECT_NE(r.outcome(), Outcome::crashed);
    for (const PartId id : r.blocked_by)
      EXPECT_TRUE(std::any_of(cast.still.begin(), cast.still.end(), [id](const auto& p) { return p.part == id; }))
          << "part " << id << " does not stand still";
    for (std::size_t i = 0; i < r.blocked_by.size(); ++i)
      EXPECT_EQ(std::count(r.blocked_by.begin(), r.blocked_by.end(), r.blocked_by[i]), 1);
    if (!r.best_pose.empty()) {
      EXPECT_EQ(r.best_pose.size(), cast.moving.size());
    }
    if (effort.max_steps > 0) {
      // Between two looks at the budget; and without dynamics a path that was found within it may still be simplified.
      constexpr std::uint64_t kSimplify = 300;
      EXPECT_LE(run.counted.steps, effort.max_steps + kLook + (run.judged.empty() ? 0 : kSimplify));
    }
    for (const auto& [path, accepted] : run.judged) {
      ASSERT_GE(path.size(), 2u);
      for (const auto& instant : path) {
        ASSERT_EQ(instant.size(), cast.moving.size());
        for (const auto& pose : instant) {
          ASSERT_TRUE(pose.t.allFinite());
          ASSERT_NEAR(pose.q.norm(), 1, 1e-9);
        }
      }
      for (std::size_t i = 0; i < cast.moving.size(); ++i)
        EXPECT_TRUE(bitwise(path.front()[i], cast.moving[i].pose)) << "starts where the parts are";
    }
    if (r.outcome() == Outcome::solved) {
      ASSERT_FALSE(run.judged.empty()) << "no path without a judge";
      EXPECT_TRUE(std::any_of(run.judged.begin(), run.judged.end(), [&](const auto& j) {
        return j.second && same(j.first, r.path()->poses());
      })) << "the judge has accepted just this path";
      const auto world = ready()->simulator->world(
          small.assembly, *ready()->prepared[static_cast<std::size_t>(&small - small_assemblies().data())], cast,
          MotionSpace::rigid);
      State end = world->initial_state();
      for (std::size_t i = 0; i < end.bodies.size(); ++i) end.bodies[i].pose = r.path()->poses().back()[i];
      EXPECT_TRUE(world->separated(end));
    } else if (r.outcome() != Outcome::start_is_goal) {
      EXPECT_FALSE(r.path()) << to_string(r.outcome());
    }
  }

  void SetUp() override {
    if (ready() == nullptr) GTEST_SKIP() << "no simulator here has what this planner needs";
  }
};

TEST_P(PathPlannerContract, DeclaresItselfInFull) {
  const PluginType& type = registry().find(PluginKind::path_planner, GetParam()).type;
  EXPECT_TRUE(problems_of_schema(type.params).empty());
  EXPECT_FALSE(type.summary.empty());
  const Capabilities says = type.traits.needs, needs = make()->traits().needs;
  EXPECT_EQ(says.dynamics, needs.dynamics);
  EXPECT_EQ(says.contacts, needs.contacts);
  EXPECT_EQ(says.distance, needs.distance);
}

TEST_P(PathPlannerContract, WhatIsSolvedHasPassedTheJudge) {
  for (std::size_t which = 0; which < small_assemblies().size(); ++which) {
    Run run;
    plan(run, which);
    if (expected("solves", GetParam())) {
      EXPECT_EQ(run.result.outcome(), Outcome::solved) << small_assemblies()[which].name;
    }
  }
}

/// One that says that it may be used by several threads finds on each what it finds alone.
TEST_P(PathPlannerContract, AConcurrentOneIsNotConfusedByOthers) {
  const auto shared = make();
  if (!shared->traits().concurrent) GTEST_SKIP() << "each thread has its own";
  const auto planned = [](PathPlanner& planner, std::size_t which) {
    const Small& small = small_assemblies()[which];
    const Cast cast = small.cast();
    const fake::RuleChecker checker([&](const Path& path) { return verify(small, cast, path); });
    const PathQuery query{
        small.assembly, *ready()->simulator, *ready()->prepared[which], cast, {.max_steps = kPlenty}, 0.01, checker};
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
    const Cast cast = small.cast_of({part.id});
    Run run;
    plan(run, which, {.max_depth = 1, .max_steps = 3'000}, {}, {}, &cast);
    EXPECT_FALSE(is_success(run.result.outcome())) << part.name;
  }
}

/// What a search in vain has reached may be gone on from when a blocker has left, by any object with the same
/// parameters; what is none of its own is ignored. All laws hold as for a search from the start.
TEST_P(PathPlannerContract, GoesOnFromWhatItReachedOrBeginsAnew) {
  const std::size_t which = 2;
  const Small& small = small_assemblies()[which];
  class Strange final : public SearchState {};
  const Strange strange;
  int solved = 0;
  for (const auto& part : small.assembly.parts) {
    if (part.id == small.leaves || part.name == "box") continue;
    const Cast closed = small.cast_of({part.id});
    Cast open = closed;
    std::erase_if(open.still, [&](const PlacedPart& p) { return p.part == small.leaves; });
    const Budget little{.max_depth = 2, .max_steps = 3'000};
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

TEST_P(PathPlannerContract, AJudgeThatAlwaysRefusesIsNeverOverruled) {
  for (const bool witness : {false, true})
    for (std::size_t which = 0; which < 2; ++which) {
      const Small& small = small_assemblies()[which];
      Run run;
      plan(run, which, {.max_steps = 5'000}, {}, [&](const Path&) {
        fake::Ruling v;
        v.has_witness = witness;
        v.part = small.leaves;
        v.other = small.leaves == 0 ? 1 : 0;
        v.point = small.assembly.parts[small.leaves].mesh->vertices.front();
        v.reason = "refused";
        return v;
      });
      EXPECT_FALSE(is_success(run.result.outcome()));
    }
}

TEST_P(PathPlannerContract, ARefusedPathIsNotShownForEver) {
  Run run;
  int refusals = 0;
  plan(run, 0, {.max_steps = kPlenty}, {}, [&](const Path& path) {
    if (refusals++ > 0) return verify(small_assemblies()[0], small_assemblies()[0].cast(), path);
    return fake::Ruling{};
  });
  EXPECT_LT(run.judged.size(), 200u);
}

TEST_P(PathPlannerContract, CancelledBeforeTheStart) {
  for (std::size_t which = 0; which < small_assemblies().size(); ++which) {
    RunContext context;
    context.cancel.cancel();
    Run run;
    plan(run, which, {}, context);
    EXPECT_EQ(run.result.outcome(), Outcome::cancelled);
    EXPECT_LE(run.counted.steps, kLook);
    EXPECT_TRUE(run.judged.empty());
  }
}

TEST_P(PathPlannerContract, CancelledOnTheWay) {
  RunContext context;
  const CancelToken cancel = context.cancel;
  Run run;
  run.counted.on_step = [&] {
    if (run.counted.steps >= 20) cancel.cancel();
  };
  plan(run, 1, {}, context);
  if (run.result.outcome() != Outcome::solved) {
    EXPECT_EQ(run.result.outcome(), Outcome::cancelled);
  }
  EXPECT_LE(run.counted.steps, 20 + 2 * kLook);
}

TEST_P(PathPlannerContract, ADeadlineThatHasPassedIsATimeout) {
  RunContext context;
  context.deadline = Deadline::after_seconds(0);
  Run run;
  plan(run, 0, {}, context);
  EXPECT_EQ(run.result.outcome(), Outcome::timeout);
  EXPECT_LE(run.counted.steps, kLook);
}

TEST_P(PathPlannerContract, StepBudgetsAreKept) {
  Run free;
  plan(free, 1);
  for (const std::uint64_t budget : {1u, 30u, 300u}) {
    Run run;
    plan(run, 1, {.max_steps = budget});  // expect_lawful looks at the steps
    if (free.counted.steps > budget + kLook) {
      EXPECT_EQ(run.result.outcome(), Outcome::timeout) << budget;
    }
  }
}

TEST_P(PathPlannerContract, APartThatIsOutHasNothingToDo) {
  Cast cast = small_assemblies()[0].cast();
  cast.moving[0].pose.t = Vector3d(0, 0, 30);
  Run run;
  plan(run, 0, {}, {}, {}, &cast);
  EXPECT_EQ(run.result.outcome(), Outcome::start_is_goal);
  for (const auto& instant : run.result.path) EXPECT_TRUE(bitwise(instant[0], cast.moving[0].pose));
}

TEST_P(PathPlannerContract, StartsFromWhereverTheCastIs) {
  Cast cast = small_assemblies()[0].cast();
  cast.moving[0].pose.t = Vector3d(0.01, -0.005, 0.4);
  Run run;
  plan(run, 0, {.max_steps = kPlenty}, {}, {}, &cast);
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
    EXPECT_EQ(a.judged.size(), b.judged.size());
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
  const Cast cast = small.cast_of(all_but_box);
  Run run;
  plan(run, 2, {.max_steps = kPlenty}, {}, {}, &cast);
}

TEST_P(PathPlannerContract, UnsupportedWhereTheSimulatorLacksSomething) {
  const Capabilities needs = make()->traits().needs;
  std::vector<Capabilities> lacking;
  const Capabilities full = ready()->simulator->capabilities();
  if (needs.dynamics) lacking.push_back({false, full.contacts, full.distance, full.max_moving});
  if (needs.contacts) lacking.push_back({full.dynamics, false, full.distance, full.max_moving});
  if (needs.distance) lacking.push_back({full.dynamics, full.contacts, false, full.max_moving});
  const Small& small = small_assemblies()[0];
  for (const Capabilities& has : lacking) {
    Counted counted;
    CountingSimulator simulator(ready()->simulator, counted);
    simulator.has = has;
    RunContext context;
    const PathQuery query{
        small.assembly, simulator, *ready()->prepared[0],
        small.cast(),   {},        [](const Path&) { return PathCheck{true, false, 0, 0, {}, 0, {}}; }};
    const PathResult r = make()->plan(query, context);
    EXPECT_EQ(r.outcome(), Outcome::unsupported);
    EXPECT_FALSE(r.message.empty()) << "says what is missing";
    EXPECT_EQ(counted.steps, 0u);
  }
}

/// Those that can be made without any parameter given. `portfolio` has to be told of whom; `guided` is one.
std::vector<std::string> complete_by_default() {
  std::vector<std::string> all = ids(PluginKind::path_planner);
  std::erase_if(all, [](const std::string& id) {
    const auto& params = registry().find(PluginKind::path_planner, id).type.params;
    return std::any_of(params.begin(), params.end(), [](const ParamSpec& p) { return p.required; });
  });
  return all;
}

INSTANTIATE_TEST_SUITE_P(Registered, PathPlannerContract, testing::ValuesIn(complete_by_default()), test_name);

}  // namespace
}  // namespace dismantle
