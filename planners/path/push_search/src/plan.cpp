#include "dismantle/push/plan.h"

#include <algorithm>
#include <optional>

#include "dismantle/push/search.h"

namespace dismantle::push {
namespace {

/// The result of the later search, with what the earlier one has counted and touched.
PathResult merged(const PathResult& earlier, PathResult later) {
  for (const auto& [name, value] : earlier.counts) later.counts[name] += value;
  for (const PartId part : earlier.blocked_by)
    if (std::find(later.blocked_by.begin(), later.blocked_by.end(), part) == later.blocked_by.end())
      later.blocked_by.push_back(part);
  if (later.message.empty() && later.outcome != Outcome::solved) later.message = earlier.message;
  return later;
}

/// Under a depth limit somebody asks for all parts in turn: most of them are blocked, and have to be found so soon.
PathResult up_to_depth(const PathQuery& query, const Tactics& tactics, unsigned depth, Search::Limits limits,
                       RunContext& context) {
  Search translation(query, MotionSpace::translation, tactics, context);
  const auto level = static_cast<std::uint64_t>(depth);
  limits.expansions = static_cast<std::uint64_t>(tactics.translation_nodes) * level;
  limits.rank = depth;  // the first level: what the contacts leave free, and the axes
  PathResult first = translation.run(limits);
  if (first.outcome != Outcome::exhausted && first.outcome != Outcome::depth_limit) return first;
  if (depth == 1) {
    first.outcome = Outcome::depth_limit;  // what cannot move may still be turned
    return first;
  }
  limits.expansions = static_cast<std::uint64_t>(tactics.rotation_nodes) * level;
  Search rotation(query, MotionSpace::rigid, tactics, context);
  return merged(first, rotation.run(limits));
}

/// By turns, until both are exhausted: what is new to each kind of motion comes before the rest of the other.
PathResult without_end(const PathQuery& query, const Tactics& tactics, Search::Limits limits, RunContext& context) {
  Search translation(query, MotionSpace::translation, tactics, context);
  std::optional<Search> rotation;
  PathResult first, second;
  first.outcome = second.outcome = Outcome::depth_limit;
  const auto goes_on = [](const PathResult& r) { return r.outcome == Outcome::depth_limit; };
  for (limits.rank = tactics.first_rank; goes_on(first) || goes_on(second); ++limits.rank) {
    if (goes_on(first)) first = translation.run(limits);
    if (!goes_on(first) && first.outcome != Outcome::exhausted) return rotation ? merged(second, first) : first;
    if (!rotation) rotation.emplace(query, MotionSpace::rigid, tactics, context);
    Search::Limits turning = limits;
    turning.rank -= std::min(turning.rank, tactics.turning_lag);
    if (goes_on(second)) second = rotation->run(turning);
    if (!goes_on(second) && second.outcome != Outcome::exhausted) break;
  }
  return merged(first, second);
}

}  // namespace

Capabilities required() { return {.dynamics = true, .contacts = true, .distance = false, .max_moving = 1}; }

PathResult plan(const PathQuery& query, const Tactics& tactics, RunContext& context) {
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
  const unsigned depth = query.effort.max_depth;
  if (tactics.motion != Motion::automatic) {
    const auto space = tactics.motion == Motion::translation ? MotionSpace::translation : MotionSpace::rigid;
    return Search(query, space, tactics, context).run(limits);
  }
  return depth > 0 ? up_to_depth(query, tactics, depth, limits, context) : without_end(query, tactics, limits, context);
}

}  // namespace dismantle::push
