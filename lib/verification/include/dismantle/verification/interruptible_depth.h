/// Penetration depth for callers with a deadline.
#pragma once

#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// As deepest_penetration(). When `context` says to stop, returns the deepest point so far, still a lower bound.
Penetration deepest_penetration(const DepthBody& a, const Pose& pose_a, const DepthBody& b, const Pose& pose_b,
                                double tolerance, const RunContext& context);

/// The same for surface points outside `region` alone, as in law 3 of the verifier: points that are in it in the
/// assembled frame of either part do not count. Of two parts that have an inside. What is less deep than `from` +
/// tolerance is not searched: a depth of `from` says that there is nothing deeper.
Penetration deepest_elsewhere(const DepthBody& a, const Pose& pose_a, const DepthBody& b, const Pose& pose_b,
                              const Aabb& region, double from, double tolerance, const RunContext& context);

}  // namespace dismantle
