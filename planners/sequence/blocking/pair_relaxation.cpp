#include "blocking/pair_relaxation.h"

#include <algorithm>
#include <string>

namespace dismantle::blocking {

bool PairRelaxation::holds(PartId a, PartId b) {
  const std::pair<PartId, PartId> key = std::minmax(a, b);
  const Pose &first = state_.pose(key.first), &second = state_.pose(key.second);
  if (const auto known = known_.find(key);
      known != known_.end() && known->second.first == first && known->second.second == second)
    return known->second.holds;
  const bool holds = search(a, b);
  if (state_.context().should_stop()) return false;
  known_.insert_or_assign(key, Answer{first, second, holds});
  return holds;
}

bool PairRelaxation::search(PartId a, PartId b) {
  const Assembly& assembly = state_.assembly();
  const auto triangles = [&](PartId part) { return assembly.parts[part].mesh->triangles.size(); };
  if (triangles(b) < triangles(a)) std::swap(a, b);
  Attempt attempt;
  attempt.moving.push_back({a, state_.pose(a)});
  attempt.fixed.push_back({b, state_.pose(b)});
  attempt.max_depth = depth_;
  const AttemptResult& answer = oracle_.attempt(attempt, state_.context());
  const Outcome outcome = answer.result.outcome();
  state_.context().log(LogLevel::debug, "search for a path of '" + assembly.parts[a].name + "' out of '" +
                                            assembly.parts[b].name + "' without the others, to depth " +
                                            std::to_string(depth_) + ": " + std::string(to_string(outcome)) + ", " +
                                            std::to_string(answer.seconds) + " s");
  return outcome == Outcome::depth_limit || outcome == Outcome::exhausted || outcome == Outcome::infeasible;
}

}  // namespace dismantle::blocking
