/// Check of two solids in both directions.
#pragma once

#include "dismantle/geometry/directed_check.h"

namespace dismantle::geometry {

/// `forward` moves A in the frame of B, `backward` moves B in the frame of A, at the same instants.
Finding check_pair(const Solid& a, const Solid& b, const RelativeMotion& forward, const RelativeMotion& backward,
                   const Limits& limits, Budget& budget);

/// True if samples show that `a` on its path exceeds the limits at `b`. Cheap compared with passes().
bool refuted_by_samples(const std::vector<Solid>& a, const std::vector<Pose>& poses_a, const std::vector<Solid>& b,
                        const Pose& pose_b, const Limits& limits);

/// Do the solids of `a`, moving along `poses_a`, respect the limits against those of `b` at `pose_b`? True is proved
/// for every instant. False: a limit is exceeded, or the check ended without a proof. The default budget, per pair of
/// solids, suffices for paths of a few segments.
bool passes(const std::vector<Solid>& a, const std::vector<Pose>& poses_a, const std::vector<Solid>& b,
            const Pose& pose_b, const Limits& limits, const Budget& per_pair = {60'000, 6'000});

}  // namespace dismantle::geometry
