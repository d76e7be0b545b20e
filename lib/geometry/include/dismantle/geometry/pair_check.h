/// Continuous collision check of two solids: the surface of each against the other.
#pragma once

#include "dismantle/geometry/directed_check.h"

namespace dismantle::geometry {

/// `forward` moves A in the frame of B, `backward` B in the frame of A; the same instants.
Finding check_pair(const Solid& a, const Solid& b, const RelativeMotion& forward, const RelativeMotion& backward,
                   const Limits& limits, Budget& budget);

/// Do the solids of `a`, along `poses_a`, penetrate those of `b`, which stays at `pose_b`, within the limits only? True
/// is proved for every instant. False: they do not, or a small fixed budget did not suffice for a proof.
bool passes(const std::vector<Solid>& a, const std::vector<Pose>& poses_a, const std::vector<Solid>& b,
            const Pose& pose_b, const Limits& limits);

}  // namespace dismantle::geometry
