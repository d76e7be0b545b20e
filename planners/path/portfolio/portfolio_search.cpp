#include "portfolio_search.h"

#include <algorithm>
#include <utility>

#include "dismantle/search/time_limit.h"

namespace dismantle::portfolio {

PortfolioSearch::PortfolioSearch(const Parameters& parameters,
                                 const std::vector<std::shared_ptr<PathPlanner>>& planners, const PathQuery& query,
                                 RunContext& context)
    : parameters_(parameters), query_(query), context_(context), members_(parameters.of, planners, query) {}

SearchStatus PortfolioSearch::run(const Budget& budget) {
  if (status_ != SearchStatus::paused) return status_;
  if (query_.simulator.capabilities().max_moving < query_.scene.moving.size()) {
    refusal_.fail(Outcome::unsupported, "the simulator cannot move this number of parts simultaneously");
    return status_ = SearchStatus::failed;
  }
  const bool depth_limited = members_.participation().depth_limited();
  if (members_.primary() == nullptr) {
    refusal_.fail(depth_limited ? Outcome::depth_limit : Outcome::unsupported,
                  "no planner of the portfolio participates in such a search");
    return status_ = depth_limited ? SearchStatus::exhausted : SearchStatus::failed;
  }
  if (!rounds_ && !fallback_) {
    if ((depth_limited ? parameters_.depth_limited_mode : parameters_.mode) == Mode::alternate)
      rounds_.emplace(members_, parameters_);
    else
      fallback_.emplace(members_, parameters_.speculative);
  }
  Portion portion{.end = path::deadline_of(budget)};
  if (budget.max_steps > 0) portion.left = budget.max_steps;
  const Decision decision = rounds_ ? rounds_->run(context_, portion) : fallback_->run(context_, portion);
  decided_by_ = decision.by != nullptr ? decision.by : members_.primary();
  return status_ = decision.status;
}

PathResult PortfolioSearch::result() {
  if (decided_by_ == nullptr) return refusal_;
  PathResult all = decided_by_->last();
  all.stats = {};
  auto state = std::make_shared<PortfolioState>();
  for (const MemberSearch& m : members_.all()) {
    const PathResult& one = m.last();
    SearchStats fixed = one.stats;
    fixed.extra.clear();
    all.stats += fixed;
    for (const auto& [name, value] : one.stats.by_name()) all.stats.extra[m.name() + "_" + name] += value;
    for (const PartId part : one.blocked_by)
      if (std::find(all.blocked_by.begin(), all.blocked_by.end(), part) == all.blocked_by.end())
        all.blocked_by.push_back(part);
    state->members.push_back(one.state);
  }
  if (is_success(all.outcome())) return all;
  if (all.message.empty()) all.message = members_.primary()->last().message;
  all.state = std::move(state);
  return all;
}

}  // namespace dismantle::portfolio
