// Laws of a portfolio, with members that follow a script, on many random portfolios.
#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>

#include "dismantle/executor.h"
#include "dismantle/testing/fake_planning.h"
#include "portfolio_search.h"

namespace dismantle::portfolio {
namespace {

/// What a scripted member does: so many steps, and then it has found a path, or has nothing left.
struct Script {
  std::uint64_t work = 100;
  bool solves = false;
  bool used_up = false;  ///< in vain because its own limit is reached, not because nothing is left
  std::uint64_t refused = 0;
  PathPlannerTraits traits{.concurrent = true, .simultaneous_motion = true, .resumable = true};
};

/// Who was run for how many steps, in this order.
struct Log {
  std::mutex mutex;
  std::vector<std::pair<std::size_t, std::uint64_t>> runs;
  std::vector<unsigned> depths;  ///< of the queries
};

struct ScriptState final : SearchState {
  explicit ScriptState(std::uint64_t d) : done(d) {}
  std::uint64_t done;
};

class Scripted final : public PathPlanner {
 public:
  Scripted(std::size_t id, const Script& script, Log& log) : id_(id), script_(script), log_(log) {}
  PathPlannerTraits traits() const noexcept override { return script_.traits; }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    const std::scoped_lock lock(log_.mutex);
    log_.depths.push_back(query.budget.max_depth);
    return std::make_unique<Run>(*this, query, context);
  }

 private:
  class Run final : public PathSearch {
   public:
    Run(const Scripted& of, const PathQuery& query, RunContext& context) : of_(of), query_(query), context_(context) {
      if (const auto* state = dynamic_cast<const ScriptState*>(query.resume_from)) before_ = state->done;
    }
    SearchStatus run(const Budget& portion) override {
      const std::uint64_t limit = query_.budget.max_steps > 0 ? query_.budget.max_steps : ~std::uint64_t{0};
      const std::uint64_t until = portion.max_steps > 0 ? done_ + portion.max_steps : ~std::uint64_t{0};
      const std::uint64_t begin = done_;
      const std::uint64_t work = of_.script_.work - std::min(of_.script_.work, before_);
      SearchStatus status = SearchStatus::paused;
      while (done_ < until) {
        if (context_.cancel.cancelled()) {
          result_.fail(Outcome::cancelled);
          status = SearchStatus::failed;
        } else if (done_ >= work) {
          status = end();
        } else if (done_ >= limit) {
          result_.fail(Outcome::timeout);
          status = SearchStatus::failed;
        } else {
          ++done_;
          continue;
        }
        break;
      }
      result_.stats.steps = done_;
      result_.stats.refused = of_.script_.refused;
      result_.stats.cost = static_cast<double>(done_);
      if (status != SearchStatus::solved) {
        if (status == SearchStatus::paused) result_.fail(Outcome::depth_limit);
        result_.state = std::make_shared<ScriptState>(before_ + done_);
      }
      const std::scoped_lock lock(of_.log_.mutex);
      of_.log_.runs.emplace_back(of_.id_, done_ - begin);
      return status;
    }
    PathResult result() override { return result_; }

   private:
    SearchStatus end() {
      if (!of_.script_.solves) {
        result_.fail(of_.script_.used_up ? Outcome::depth_limit : Outcome::exhausted,
                     "member " + std::to_string(of_.id_));
        return SearchStatus::exhausted;
      }
      PathCheck check = query_.checker.check(fake::straight(query_.cast, Eigen::Vector3d(0, 0, 1.0 + of_.id_)));
      result_.solve(std::move(*check.verified), 1);
      return SearchStatus::solved;
    }

    const Scripted& of_;
    const PathQuery& query_;
    RunContext& context_;
    std::uint64_t done_ = 0, before_ = 0;
    PathResult result_ = PathResult::failure(Outcome::depth_limit);
  };

  std::size_t id_;
  Script script_;
  Log& log_;
};

/// A portfolio of scripts, and a query about the block of a tube.
struct Set {
  std::vector<Script> scripts;
  Parameters parameters;
  Budget budget;
  Log log;
  std::shared_ptr<Executor> executor;
  Assembly assembly = fake::tube_with_blocks(1);
  fake::Physics physics;
  Prepared prepared;
  fake::RuleChecker checker = fake::accept_all();
  std::shared_ptr<const SearchState> resume_from;
  RunContext context;
  SearchStatus status = SearchStatus::paused;

  void add(const Script& script, const Member& member = {}) {
    scripts.push_back(script);
    parameters.of.push_back(member);
    parameters.of.back().plugin = PluginRef<PathPlanner>("member" + std::to_string(scripts.size()));
  }
  /// Runs it in portions of so many steps; 0: in one.
  PathResult run(std::uint64_t portion = 0) {
    log.runs.clear();
    log.depths.clear();
    std::vector<std::shared_ptr<PathPlanner>> planners;
    for (std::size_t k = 0; k < scripts.size(); ++k) planners.push_back(std::make_shared<Scripted>(k, scripts[k], log));
    context.executor = executor;
    const PathQuery query{assembly, physics, prepared,         {{{1, Pose{}}}, {{0, Pose{}}}}, budget, 0.01,
                          checker,  {},      resume_from.get()};
    PortfolioSearch search(parameters, planners, query, context);
    do status = search.run({.max_steps = portion});
    while (status == SearchStatus::paused);
    EXPECT_EQ(search.run({}), status) << "what has ended has ended";
    return search.result();
  }
  std::uint64_t spent(std::size_t member) const {
    std::uint64_t sum = 0;
    for (const auto& [id, steps] : log.runs) sum += id == member ? steps : 0;
    return sum;
  }
};

Script random_script(Rng& rng) {
  Script s;
  s.work = rng.below(400);
  s.solves = rng.below(3) == 0;
  s.used_up = rng.below(2) == 0;
  return s;
}

/// Any mode, any conditions that hold back nobody for good.
void fill_at_random(Set& set, Rng& rng) {
  set.parameters.mode = rng.below(2) == 0 ? Mode::fallback : Mode::alternate;
  set.parameters.turn = 1 + static_cast<std::int64_t>(rng.below(100));
  set.parameters.growth = 1 + rng.uniform(0, 2);
  for (auto n = 1 + rng.below(4); n > 0; --n) {
    Member member;
    member.after = rng.below(2) == 0 ? 0 : static_cast<std::int64_t>(rng.below(300));
    member.whole = rng.below(4) == 0;
    set.add(random_script(rng), member);
  }
}

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
  // The second begins in the round in which the first has spent 25; the first is alone at the end.
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
  // The block is 0.4 times as large as the tube, about.
  EXPECT_EQ(run_by({.least_depth = 1, .least_depth_large = 3, .large = 0.2}, 2), -1);
  EXPECT_EQ(run_by({.least_depth = 1, .least_depth_large = 3, .large = 0.9}, 2), 2);
  EXPECT_EQ(run_by({.large = 0.2, .size = Size::small}, 0), -1);
  EXPECT_EQ(run_by({.large = 0.2, .size = Size::large}, 0), 0);
  EXPECT_EQ(run_by({.large = 0.9, .size = Size::small}, 0), 0);
  EXPECT_EQ(run_by({.large = 0.9, .size = Size::large}, 0), -1);
  // The verifier has refused what the first has found, and it has nothing else.
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

/// Whether or not a thread was idle.
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
