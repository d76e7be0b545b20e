#include "dismantle/push/plan.h"

#include <algorithm>
#include <utility>

namespace dismantle::push {
namespace {

constexpr std::uint64_t kStepsPerLevel = 2000;  // of a depth limit: simulated, translating as well as turning

/// The result of the later search, with what the earlier one has counted and touched.
PathResult merged(const PathResult& earlier, PathResult later) {
  for (const auto& [name, value] : earlier.counts) later.counts[name] += value;
  for (const PartId part : earlier.blocked_by)
    if (std::find(later.blocked_by.begin(), later.blocked_by.end(), part) == later.blocked_by.end())
      later.blocked_by.push_back(part);
  if (later.message.empty() && later.outcome != Outcome::solved) later.message = earlier.message;
  return later;
}

/// With a part of the steps that are left. What ends because it has had that part may go on another time.
PathResult with_share(Search&& search, Search::Limits limits, std::uint64_t share) {
  const std::uint64_t left = limits.steps_left != nullptr ? *limits.steps_left : ~std::uint64_t{0};
  const std::uint64_t most = std::min(left, share);
  std::uint64_t own = most;
  std::uint64_t* const all = std::exchange(limits.steps_left, &own);
  PathResult result = search.run(limits);
  if (all != nullptr) *all -= most - own;
  if (result.outcome == Outcome::timeout && own == 0 && most < left) result.outcome = Outcome::depth_limit;
  return result;
}

/// Under a depth limit somebody asks for all parts in turn: most of them are blocked, and have to be found so soon. A
/// part that slides or turns in its play can do so for long, so simulated steps are limited, too.
PathResult up_to_depth(const PathQuery& query, const Tactics& tactics, unsigned depth, Search::Limits limits,
                       RunContext& context) {
  const auto level = static_cast<std::uint64_t>(depth);
  limits.expansions = static_cast<std::uint64_t>(tactics.translation_nodes) * level;
  limits.rank = depth;  // the first level: what the contacts leave free, and the axes
  PathResult first =
      with_share(Search(query, MotionSpace::translation, tactics, context), limits, kStepsPerLevel * level);
  if (first.outcome != Outcome::exhausted && first.outcome != Outcome::depth_limit) return first;
  if (depth == 1) {
    first.outcome = Outcome::depth_limit;  // what cannot move may still be turned
    return first;
  }
  limits.expansions = static_cast<std::uint64_t>(tactics.rotation_nodes) * level;
  return merged(first, with_share(Search(query, MotionSpace::rigid, tactics, context), limits, kStepsPerLevel * level));
}

/// Likewise where each part moves in its own way. A state has many more actions then, so it is simulated steps that are
/// counted, and somebody mostly turns, so that is looked at from the first level on.
PathResult each_its_way(const PathQuery& query, const Tactics& tactics, unsigned depth, Search::Limits limits,
                        RunContext& context) {
  limits.rank = 1 + depth / 2;  // one driven, and two along one axis; from the second level on across, too
  const auto run = [&](MotionSpace space) {
    return with_share(Search(query, space, tactics, context), limits,
                      static_cast<std::uint64_t>(tactics.steps_at_once) * depth);
  };
  const PathResult first = run(MotionSpace::translation);
  if (first.outcome != Outcome::exhausted && first.outcome != Outcome::depth_limit) return first;
  return merged(first, run(MotionSpace::rigid));
}

}  // namespace

Capabilities required() { return {.dynamics = true, .contacts = true, .distance = false, .max_moving = 1}; }

ByTurns::ByTurns(const PathQuery& query, const Tactics& tactics, RunContext& context)
    : query_(query),
      tactics_(tactics),
      context_(context),
      translation_(query, MotionSpace::translation, tactics, context),
      rank_(tactics.first_rank) {
  first_.outcome = second_.outcome = Outcome::depth_limit;
}

PathResult ByTurns::run(const Search::Limits& limits) {
  const auto goes_on = [](const PathResult& r) { return r.outcome == Outcome::depth_limit; };
  paused_ = false;
  Search::Limits turn = limits;
  while (goes_on(first_) || goes_on(second_)) {
    turn.rank = turning_ ? rank_ - std::min(rank_, tactics_.turning_lag) : rank_;
    if (turning_ && !rotation_) rotation_.emplace(query_, MotionSpace::rigid, tactics_, context_);
    Search& search = turning_ ? *rotation_ : translation_;
    PathResult& result = turning_ ? second_ : first_;
    if (goes_on(result)) result = search.run(turn);
    if (!goes_on(result) && result.outcome != Outcome::exhausted) break;
    paused_ = goes_on(result) && search.paused();
    if (paused_) break;
    if (turning_) ++rank_;
    turning_ = !turning_;
  }
  if (turning_) return merged(first_, second_);
  return rotation_ ? merged(second_, first_) : first_;
}

PathResult plan(const PathQuery& query, const Tactics& tactics, RunContext& context,
                const std::function<void()>& between) {
  const Capabilities has = query.simulator.capabilities();
  if (!has.dynamics || !has.contacts || has.max_moving < query.cast.moving.size()) {
    PathResult result;
    result.outcome = Outcome::unsupported;
    result.message = "pushing needs a simulator with dynamics and contacts for all moving parts";
    return result;
  }
  std::uint64_t steps_left = query.effort.max_steps;
  Search::Limits limits;
  limits.deadline = query.effort.timeout > 0 ? Deadline::after_seconds(query.effort.timeout) : Deadline();
  limits.steps_left = query.effort.max_steps > 0 ? &steps_left : nullptr;
  limits.between = between;
  const unsigned depth = query.effort.max_depth;
  if (tactics.motion != Motion::automatic) {
    const auto space = tactics.motion == Motion::translation ? MotionSpace::translation : MotionSpace::rigid;
    return Search(query, space, tactics, context).run(limits);
  }
  if (depth > 0 && !query.leaving.empty()) return each_its_way(query, tactics, depth, limits, context);
  return depth > 0 ? up_to_depth(query, tactics, depth, limits, context) : ByTurns(query, tactics, context).run(limits);
}

}  // namespace dismantle::push
