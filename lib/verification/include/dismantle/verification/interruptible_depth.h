/// Penetration depth for callers with a deadline, or with knowledge of what they need.
#pragma once

#include <limits>

#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// What to search for; lengths in the unit of the meshes.
struct DepthSearch {
  double tolerance = 0;  ///< > 0; error of the answer
  double from = 0;       ///< what is less deep than this + `tolerance` is not searched
  double enough = std::numeric_limits<double>::infinity();  ///< the search ends at the first point so deep
  /// Points that are in this box in the assembled frame of either part do not count, as in law 3 of the verifier. Of
  /// two parts that have an inside. Null: all points count.
  const Aabb* left_out = nullptr;
};

/// As deepest_penetration(). A depth of `from` says that there is nothing deeper; its point is undefined. When
/// `context` says to stop, returns the deepest point so far, still a lower bound.
Penetration deepest_penetration(const DepthBody& a, const Pose& pose_a, const DepthBody& b, const Pose& pose_b,
                                const DepthSearch& search, const RunContext& context);

}  // namespace dismantle
