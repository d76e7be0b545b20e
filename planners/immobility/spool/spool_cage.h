/// Proof that a spool of one part cannot leave a hole of another, because its rims are too wide.
#pragma once

#include <optional>

#include "dismantle/immobility/interior_circle.h"
#include "dismantle/immobility/section.h"
#include "dismantle/run_context.h"
#include "spool/spool.h"

namespace dismantle::immobility {

/// Distance of the point, in the plane of the curve, from the curve's convex hull. Returns `least` if the distance is
/// less, or if the curve is somewhere further than `max_dent` from the piece of the hull beside it.
double convex_reach(const Loop& loop, const Eigen::Vector3d& center, double least, double max_dent);

struct SpoolCage {
  InteriorCircle circle;        ///< within the part around the spool
  double below = 0, above = 0;  ///< offsets of the rims' planes along the circle's axis
  double rim = 0;               ///< diameter of the narrower of the two rims, through its middle; > 2 * circle.radius
};

/// Proves that the spool is held in a hole of the solid `around`: on either side it has a rim that is wider than a
/// circle about the hole, which lies at least `depth` (> 0) below the surface. Returns nullopt if not found, or told to
/// stop. `slack`: rims are wider by more than this. `max_dent`: rims differ from convex curves by no more than this.
/// Both in assembly units, > 0.
///
/// Why it stays: the surface of the spool never meets the circle, so its rims and a line on it from rim to rim do not.
/// A rim is convex, or so close to a convex curve that the circle does not meet that curve either. As with ring_cage(),
/// the circle's disc crosses the rim in two points or none. The arc of the rim that the disc cuts off is always the
/// shorter one, since the chord does not reach the middle of the rim. The parity of the crossings of the line with the
/// disc changes only when an end of the line crosses the disc, and then that end changes between the long arc of its
/// rim and the short one. At first the line crosses once. If the parts were apart, nothing would cross the disc: both
/// ends would be on long arcs as at first, and yet the number of crossings would be even.
std::optional<SpoolCage> spool_cage(const Solid& spool, const Solid& around, double depth, double slack,
                                    double max_dent, const SpoolParameters& params, const RunContext& context);

}  // namespace dismantle::immobility
