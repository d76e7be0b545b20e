/// A spool of one part in a hole of another, whose rims are too wide for the hole.
#pragma once

#include <cstddef>
#include <optional>

#include "dismantle/immobility/inner_ring.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

struct SpoolCage {
  InnerRing ring;  ///< within the part around the spool
  double rim = 0;  ///< diameter of the narrower of the two rims, through its middle; > 2 * ring.radius
};

/// Is the spool in a hole of the solid `around`, with a rim on either side that is too wide for a ring about the hole,
/// which lies `depth` (> 0) below the surface and more? So many rings about an axis are tried. Nothing: not found, or
/// told to stop.
///
/// Why it stays. The surface of the spool keeps out of the ring, so its rims and a line on it from rim to rim do. As
/// with ring_cage(), a rim, which is convex (or so near to a convex curve that the ring keeps out of that), is crossed
/// by the ring's disc in two points or none, and the arc of the rim that the disc cuts off is always the shorter one,
/// for the chord does not reach the middle of the rim. How often the line crosses the disc, even or odd, changes when
/// an end of it does, which then changes sides between the long arc of its rim and the short one. At first the line
/// crosses once. If the parts were apart, nothing would cross the disc: both ends on long arcs as at first, and yet an
/// even number.
std::optional<SpoolCage> spool_cage(const Solid& spool, const Solid& around, double depth, std::size_t most_rings,
                                    const RunContext& context);

}  // namespace dismantle::immobility
