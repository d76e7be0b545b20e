/// Portfolios whose members follow a script.
#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/executor.h"
#include "dismantle/testing/fake_planning.h"
#include "portfolio_search.h"

namespace dismantle::portfolio {

/// A scripted member does `work` steps; then it has found a path, or is exhausted.
struct Script {
  std::uint64_t work = 100;
  bool solves = false;
  bool used_up = false;  ///< unsuccessful because its own limit is reached, not because it is exhausted
  std::uint64_t refused = 0;
  PathPlannerTraits traits{.concurrent = true, .simultaneous_motion = true, .resumable = true};
};

/// Members and the numbers of steps for which they were run, in order.
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
      std::uint64_t until = portion.max_steps > 0 ? done_ + portion.max_steps : ~std::uint64_t{0};
      const Deadline end_of_portion = portion.timeout > 0 ? Deadline::after_seconds(portion.timeout) : Deadline();
      if (portion.timeout > 0) until = done_ + 1;  // a step takes longer than the portion
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
      while (portion.timeout > 0 && !end_of_portion.passed()) {
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
      PathCheck check = query_.checker.check(fake::straight(query_.scene, Eigen::Vector3d(0, 0, 1.0 + of_.id_)));
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
  PreparedAssembly prepared;
  fake::RuleChecker checker = fake::accept_all();
  std::shared_ptr<const SearchState> resume_from;
  RunContext context;
  SearchStatus status = SearchStatus::paused;
  std::uint64_t portions = 0;  ///< of the last run()

  void add(const Script& script, const Member& member = {}) {
    scripts.push_back(script);
    parameters.of.push_back(member);
    parameters.of.back().plugin = PluginRef<PathPlanner>("member" + std::to_string(scripts.size()));
  }
  /// Runs it in portions of this many steps; 0: in one.
  PathResult run(std::uint64_t portion = 0) { return run(Budget{.max_steps = portion}); }
  PathResult run(const Budget& portion) {
    portions = 0;
    log.runs.clear();
    log.depths.clear();
    std::vector<std::shared_ptr<PathPlanner>> planners;
    for (std::size_t k = 0; k < scripts.size(); ++k) planners.push_back(std::make_shared<Scripted>(k, scripts[k], log));
    context.executor = executor;
    const PathQuery query{assembly, physics, prepared,         {{{1, Pose{}}}, {{0, Pose{}}}}, budget, 0.01,
                          checker,  {},      resume_from.get()};
    PortfolioSearch search(parameters, planners, query, context);
    do {
      status = search.run(portion);
      ++portions;
    } while (status == SearchStatus::paused);
    EXPECT_EQ(search.run({}), status) << "what has ended has ended";
    return search.result();
  }
  std::uint64_t spent(std::size_t member) const {
    std::uint64_t sum = 0;
    for (const auto& [id, steps] : log.runs) sum += id == member ? steps : 0;
    return sum;
  }
};

inline Script random_script(Rng& rng) {
  Script s;
  s.work = rng.below(400);
  s.solves = rng.below(3) == 0;
  s.used_up = rng.below(2) == 0;
  return s;
}

/// Any mode, and any conditions under which each member runs eventually.
inline void fill_at_random(Set& set, Rng& rng) {
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

}  // namespace dismantle::portfolio
