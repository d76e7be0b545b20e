#include "dismantle/push_search/phases.h"

#include <algorithm>
#include <utility>

namespace dismantle::push {

/// Under a depth limit the sequence planner asks for all parts in turn. Most of them are blocked, so the search has to
/// end soon. A part can slide or rotate in its play for a long time, so the work is limited, too. Where parts move
/// independently, only the work is limited: with rotation in proportion to the number of parts on the first level,
/// which is asked of many sets, and from the second level on to the number of actions, which grows with its square.
/// Rotation is searched from the first level on, because usually one of the parts rotates.
std::deque<Phase> phases_of(const PathQuery& query, const Tactics& tactics) {
  if (tactics.motion != Motion::automatic)
    return {{tactics.motion == Motion::translation ? MotionSpace::translation : MotionSpace::rigid, ~0U, 0, {}}};
  const unsigned depth = query.budget.max_depth;
  const auto level = static_cast<std::uint64_t>(depth);
  const std::uint64_t work = static_cast<std::uint64_t>(tactics.level_steps) * level;
  if (!query.goal.any_of.empty()) {
    // One driven part, and two along one axis; from the second level on also two across.
    const unsigned rank = 1 + depth / 2;
    const std::uint64_t parts = query.scene.moving.size(), share = depth > 1 ? parts * parts : parts;
    return {{MotionSpace::translation, rank, 0, work}, {MotionSpace::rigid, rank, 0, share * work}};
  }
  // The rank is limited to the depth: at the first level, free directions and axes.
  std::deque<Phase> phases{
      {MotionSpace::translation, depth, static_cast<std::uint64_t>(tactics.translation_nodes) * level, work}};
  if (depth > 1)
    phases.push_back({MotionSpace::rigid, depth, static_cast<std::uint64_t>(tactics.rotation_nodes) * level, work});
  return phases;
}

Phases::Phases(const PathQuery& query, const Tactics& tactics, RunContext& context)
    : query_(query), tactics_(tactics), context_(context), phases_(phases_of(query, tactics)) {}

void Phases::begin() {
  if (std::exchange(begun_, true)) return;
  const Phase first = phases_.front();
  Search search(query_, first.space, tactics_, context_);
  if (search.needs_screw())
    phases_.push_front({MotionSpace::rigid, 0, 1, first.most_work});
  else
    begin_phase(std::move(search));
}

/// Work saved by resuming counts, up to half of what the phase may use.
void Phases::begin_phase(Search search) {
  const Phase& phase = phases_.front();
  if (phase.space == MotionSpace::rigid && reached_->rigid) search.resume(*reached_->rigid);  // of the screw phase
  if (phase.most_work) work_left_ = *phase.most_work - std::min(search.spared(), *phase.most_work / 2);
  current_.emplace(std::move(search));
}

SearchStatus Phases::run(Limits limits, PathResult& result) {
  begin();
  const double begin_cost = result.stats.cost;
  const Limits whole = limits;
  while (!phases_.empty()) {
    const SearchStatus status = run_phase(limits, result);
    if (status != SearchStatus::exhausted) return status;
    phases_.pop_front();
    ended_ = result;
    limits.pause_after = whole.pause_left(static_cast<std::uint64_t>(result.stats.cost - begin_cost));
    // A part that cannot translate may still rotate, which the first level does not search.
    if (phases_.empty() && tactics_.motion == Motion::automatic && query_.budget.max_depth == 1 &&
        query_.goal.any_of.empty())
      result.fail(Outcome::depth_limit);
  }
  return status_of(result.outcome());
}

/// `exhausted`: the next phase follows.
SearchStatus Phases::run_phase(Limits limits, PathResult& result) {
  if (!current_) begin_phase(Search(query_, phases_.front().space, tactics_, context_));
  limits.rank = phases_.front().rank;
  limits.expansions = phases_.front().expansions;
  PathResult now = run_current(limits);
  result = ended_ ? merged(*ended_, std::move(now)) : std::move(now);
  if (current_->paused()) return SearchStatus::paused;
  const SearchStatus status = status_of(result.outcome());
  if (status == SearchStatus::exhausted) {
    keep_tree();
    current_.reset();
  }
  return status;
}

/// Counts the work of the phase and of the query. A phase that has used up its own work can be resumed.
PathResult Phases::run_current(Limits limits) {
  if (!phases_.front().most_work) return current_->run(limits);
  std::uint64_t* const of_query = limits.work_left;
  const std::uint64_t left = of_query != nullptr ? *of_query : ~std::uint64_t{0};
  const std::uint64_t most = std::min(left, work_left_);
  std::uint64_t rest = most;
  limits.work_left = &rest;
  PathResult result = current_->run(limits);
  work_left_ -= most - rest;
  if (of_query != nullptr) *of_query -= most - rest;
  if (result.outcome() == Outcome::timeout && rest == 0 && most < left) result.fail(Outcome::depth_limit);
  return result;
}

/// Keeps the tree of the current phase.
void Phases::keep_tree() {
  if (!current_) return;
  if (reached_.use_count() > 1) reached_ = std::make_shared<Reached>(*reached_);  // results must not change afterwards
  (phases_.front().space == MotionSpace::translation ? reached_->translation : reached_->rigid) = current_->tree();
}

std::shared_ptr<const Reached> Phases::reached() {
  keep_tree();
  return reached_;
}

}  // namespace dismantle::push
