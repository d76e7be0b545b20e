#include "dismantle/push_search/plan.h"

#include <cstdint>
#include <optional>
#include <utility>

#include "dismantle/push_search/alternation.h"
#include "dismantle/push_search/phases.h"
#include "dismantle/search/ended_search.h"
#include "dismantle/search/time_limit.h"

namespace dismantle::push {
namespace {

class PushSearch final : public PathSearch {
 public:
  PushSearch(const PathQuery& query, const Tactics& tactics, RunContext& context, std::function<void()> between)
      : query_(query),
        context_(context),
        between_(std::move(between)),
        deadline_(path::deadline_of(query.budget)),
        work_left_(query.budget.max_steps) {
    if (tactics.motion == Motion::automatic && query.budget.max_depth == 0)
      alternation_.emplace(query, tactics, context);
    else
      phases_.emplace(query, tactics, context);
    result_.fail(Outcome::depth_limit);
  }

  SearchStatus run(const Budget& portion) override;
  PathResult result() override;

 private:
  const PathQuery& query_;
  RunContext& context_;
  std::function<void()> between_;
  Deadline deadline_;
  std::uint64_t work_left_;
  std::optional<Alternation> alternation_;  ///< one of these two
  std::optional<Phases> phases_;
  PathResult result_;
};

SearchStatus PushSearch::run(const Budget& portion) {
  if (is_success(result_.outcome())) return SearchStatus::solved;
  const bool work_is_limited = query_.budget.max_steps > 0;
  const Deadline end = path::deadline_of(portion);
  Limits limits;
  limits.deadline = deadline_.earlier(end);
  limits.work_left = work_is_limited ? &work_left_ : nullptr;
  limits.pause_after = portion.max_steps;
  limits.between = between_;
  if (alternation_) {
    result_ = alternation_->run(limits);
    if (alternation_->paused()) return SearchStatus::paused;
  } else if (phases_->run(limits, result_) == SearchStatus::paused) {
    return SearchStatus::paused;
  }
  const bool only_the_portion = result_.outcome() == Outcome::timeout && end.passed() && !deadline_.passed() &&
                                !context_.deadline.passed() && (!work_is_limited || work_left_ > 0);
  return only_the_portion ? SearchStatus::paused : status_of(result_.outcome());
}

PathResult PushSearch::result() {
  PathResult result = result_;
  const Outcome outcome = result.outcome();
  const bool resumable =
      outcome == Outcome::exhausted || outcome == Outcome::depth_limit || outcome == Outcome::timeout;
  if (resumable) result.state = alternation_ ? alternation_->reached() : phases_->reached();
  return result;
}

}  // namespace

Capabilities required() { return {.dynamics = true, .contacts = true, .distance = false, .max_moving = 1}; }

bool fits(const PathQuery& query) {
  const Capabilities has = query.simulator.capabilities();
  return has.dynamics && has.contacts && has.max_moving >= query.scene.moving.size();
}

std::unique_ptr<PathSearch> start(const PathQuery& query, const Tactics& tactics, RunContext& context,
                                  std::function<void()> between) {
  if (!fits(query))
    return path::unsupported("pushing needs a simulator with dynamics and contacts for all moving parts");
  return std::make_unique<PushSearch>(query, tactics, context, std::move(between));
}

}  // namespace dismantle::push
