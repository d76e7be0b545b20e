#include "dismantle/push/push_path_search.h"

#include <algorithm>

namespace dismantle::push {
namespace {

/// The smaller limit; 0 = none.
template <class Number>
Number stricter(Number a, Number b) {
  return a == 0 ? b : b == 0 ? a : std::min(a, b);
}

}  // namespace

PushPathSearch::PushPathSearch(const PathQuery& query, const Tactics& tactics, RunContext& context)
    : query_(query),
      tactics_(tactics),
      context_(context),
      deadline_(query.budget.timeout > 0 ? Deadline::after_seconds(query.budget.timeout) : Deadline()),
      steps_left_(query.budget.max_steps) {}

SearchStatus PushPathSearch::run(const Budget& portion) {
  if (status_ != SearchStatus::paused) return status_;
  const bool in_turns = supported(query_) && tactics_.motion == Motion::automatic && query_.budget.max_depth == 0;
  return status_ = in_turns ? run_turns(portion) : run_whole(portion);
}

SearchStatus PushPathSearch::run_turns(const Budget& portion) {
  if (!turns_) turns_.emplace(query_, tactics_, context_);
  Search::Limits limits;
  limits.deadline = portion.timeout > 0 ? deadline_.earlier(Deadline::after_seconds(portion.timeout)) : deadline_;
  limits.steps_left = query_.budget.max_steps > 0 ? &steps_left_ : nullptr;
  limits.pause_after = portion.max_steps;
  limits.between = [this] { context_.pause_point(); };
  last_ = turns_->run(limits);
  if (turns_->paused()) return SearchStatus::paused;
  const bool own_limit =
      context_.should_stop() || deadline_.passed() || (query_.budget.max_steps > 0 && steps_left_ == 0);
  if (last_.outcome() == Outcome::timeout && portion.timeout > 0 && !own_limit) {
    turns_->go_on();
    return SearchStatus::paused;
  }
  return status_of(last_.outcome());
}

SearchStatus PushPathSearch::run_whole(const Budget& portion) {
  PathQuery query = query_;
  query.budget.max_steps = stricter(query.budget.max_steps, portion.max_steps);
  const double left = query_.budget.timeout > 0 ? std::max(1e-9, deadline_.seconds_left()) : 0;
  query.budget.timeout = stricter(left, portion.timeout);
  last_ = plan(query, tactics_, context_, [this] { context_.pause_point(); });
  const bool own_limit =
      context_.should_stop() || deadline_.passed() ||
      (query_.budget.max_steps > 0 && last_.stats.steps + last_.stats.state_checks >= query_.budget.max_steps);
  const bool cut_short = portion.max_steps > 0 || portion.timeout > 0;
  if (last_.outcome() == Outcome::timeout && cut_short && !own_limit) return SearchStatus::paused;
  return status_of(last_.outcome());
}

PathResult PushPathSearch::result() {
  PathResult result = last_;
  const bool unfinished = result.outcome() == Outcome::depth_limit || result.outcome() == Outcome::exhausted ||
                          result.outcome() == Outcome::timeout;
  if (turns_ && unfinished) result.state = turns_->reached();
  return result;
}

}  // namespace dismantle::push
