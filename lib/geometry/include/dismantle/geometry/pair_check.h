/// Both directions of the check of two solids.
#pragma once

#include "dismantle/geometry/directed_check.h"

namespace dismantle::geometry {

/// `forward` moves A in the frame of B, `backward` B in the frame of A; the same instants.
Finding check_pair(const Solid& a, const Solid& b, const RelativeMotion& forward, const RelativeMotion& backward,
                   const Limits& limits, Budget& budget);

/// Do the solids of `a`, along `poses_a`, keep to the limits with those of `b`, which is at `pose_b`? True
/// is proved for every instant; false: they do not, or the budget per pair of solids did not suffice for a proof. The
/// default suffices for paths of a few segments.
bool passes(const std::vector<Solid>& a, const std::vector<Pose>& poses_a, const std::vector<Solid>& b,
            const Pose& pose_b, const Limits& limits, const Budget& per_pair = {60'000, 6'000});

}  // namespace dismantle::geometry
