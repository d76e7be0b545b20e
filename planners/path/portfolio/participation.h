/// Which members of a portfolio participate in a search.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "dismantle/path_planner.h"
#include "parameters.h"

namespace dismantle::portfolio {

/// Conditions of a member that depend on the query alone: its goal, its depth limit, and the size of the group.
class Participation {
 public:
  /// `query` outlives this.
  explicit Participation(const PathQuery& query) : query_(query) {}

  /// The query has a depth limit.
  bool depth_limited() const { return query_.budget.max_depth > 0; }
  /// Whether the member may be run at all; under a depth limit perhaps only if paths were refused.
  bool takes_part(const Member& member, const PathPlannerTraits& traits);
  /// Whether the depth limit is large enough for the member.
  bool deep_enough(const Member& member);

 private:
  bool is_large(const Member& member);

  const PathQuery& query_;
  std::optional<std::pair<double, double>> diagonals_;  ///< of the boxes of the moving and of the fixed parts
};

}  // namespace dismantle::portfolio
