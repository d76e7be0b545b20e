/// Penetration depth for callers with a deadline.
#pragma once

#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// As deepest_penetration(). When `context` says to stop, returns the deepest point so far, still a lower bound.
Penetration deepest_penetration(const DepthBody& a, const Pose& pose_a, const DepthBody& b, const Pose& pose_b,
                                double tolerance, const RunContext& context);

}  // namespace dismantle
