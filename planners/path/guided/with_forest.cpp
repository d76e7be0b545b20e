#include "with_forest.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "dismantle/push/plan.h"
#include "growth.h"

namespace dismantle::guided {
namespace {

/// Nothing was found and nobody stopped it: it may go on, or has nothing left.
bool undecided(const PathResult& r) { return r.outcome == Outcome::depth_limit || r.outcome == Outcome::exhausted; }

/// What both have counted and touched, in the one that says how it ended.
PathResult together(PathResult end, const PathResult& pushes, const PathResult& forest) {
  std::map<std::string, double> counts = pushes.counts;
  for (const auto& [name, value] : forest.counts) counts["forest_" + name] = value;
  end.counts = std::move(counts);
  for (const auto* other : {&pushes, &forest})
    for (const PartId part : other->blocked_by)
      if (std::find(end.blocked_by.begin(), end.blocked_by.end(), part) == end.blocked_by.end())
        end.blocked_by.push_back(part);
  if (end.message.empty() && !is_success(end.outcome)) end.message = pushes.message;
  return end;
}

}  // namespace

PathResult plan_with_forest(const PathQuery& query, const Parameters& parameters, const push::Tactics& tactics,
                            RunContext& context) {
  constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t steps_left = query.effort.max_steps > 0 ? query.effort.max_steps : kUnlimited;
  push::Search::Limits limits;
  limits.deadline = query.effort.timeout > 0 ? Deadline::after_seconds(query.effort.timeout) : Deadline();
  limits.steps_left = query.effort.max_steps > 0 ? &steps_left : nullptr;
  limits.pause_after = static_cast<std::uint64_t>(parameters.forest_after);
  const auto most = static_cast<std::uint64_t>(parameters.forest_steps);

  push::ByTurns pushing(query, tactics, context);
  std::optional<tunnel_forest::Growth> growth;
  PathResult pushes, forest;
  bool pushing_ends = false, forest_ends = false;
  while (!pushing_ends || !forest_ends) {
    if (!pushing_ends) {
      pushes = pushing.run(limits);
      if (!undecided(pushes)) return together(pushes, pushes, forest);
      pushing_ends = !pushing.paused();
    }
    if (!forest_ends) {
      if (!growth) growth.emplace(tunnel_forest::Parameters{}, query, context);
      const std::uint64_t before = growth->used();
      forest = growth->run(std::min(most, before + std::min(steps_left, limits.pause_after)));
      if (limits.steps_left != nullptr) steps_left -= std::min(steps_left, growth->used() - before);
      if (!undecided(forest)) return together(forest, pushes, forest);
      if (steps_left == 0) {
        forest.outcome = Outcome::timeout;
        return together(forest, pushes, forest);
      }
      forest_ends = forest.outcome == Outcome::exhausted || growth->used() >= most;
    }
    limits.pause_after *= 2;
  }
  return together(pushes, pushes, forest);
}

}  // namespace dismantle::guided
