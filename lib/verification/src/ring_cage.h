/// A ring of one part in a chamber of another, all of whose openings are too small for it; or around the neck of a
/// spool, whose rims are too wide for the ring.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dismantle/run_context.h"
#include "solid.h"

namespace dismantle::verify {

/// A circle within a solid, everywhere deeper below its surface than was asked for. Assembled frame.
struct InnerRing {
  Eigen::Vector3d center = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::UnitZ();
  double radius = 0;
};

struct RingCage {
  InnerRing ring;
  double opening = 0;  ///< diameter of the largest opening of the chamber; < 2 * ring.radius
};

/// Large rings in the solid, `depth` (> 0) below its surface and more; the largest first.
std::vector<InnerRing> rings_in(const Solid& solid, double depth, std::size_t most);

/// Is the ring in a chamber of the solid that it cannot leave? Nothing: no such chamber was found, or told to stop.
///
/// Why it cannot. The surface of the solid keeps out of the ring: where the two met, it would be deeper in the ring's
/// part than is allowed. The chamber is closed by a piece of that surface and by flat discs whose borders are curves on
/// the surface. So the ring gets out only through discs. With the border of a disc it is not linked, at first and hence
/// always, so it crosses the disc in two points or none. The chord between two is shorter than the ring's diameter, so
/// one arc of the ring is the shorter one, and that is the one which began to cross when the ring first touched the
/// disc; it never grows to half of the ring. When the ring crosses no disc, all arcs are gone, and it is inside again.
/// So a point of the ring is always in the chamber or on one of its discs.
std::optional<RingCage> ring_cage(const InnerRing& ring, const Solid& around, const RunContext& context);

struct SpoolCage {
  InnerRing ring;  ///< within the part around the spool
  double rim = 0;  ///< diameter of the narrower of the two rims, through its middle; > 2 * ring.radius
};

/// Is the spool in a hole of the solid `around`, with a rim on either side that is too wide for a ring about the hole,
/// which lies `depth` (> 0) below the surface and more? Nothing: not found, or told to stop.
///
/// Why it stays. The surface of the spool keeps out of the ring, so its rims and a line on it from rim to rim do. As
/// with ring_cage(), a rim, which is convex (or so near to a convex curve that the ring keeps out of that), is crossed
/// by the ring's disc in two points or none, and the arc of the rim that the disc cuts off is always the shorter one,
/// for the chord does not reach the middle of the rim. How often the line crosses the disc, even or odd, changes when
/// an end of it does, which then changes sides between the long arc of its rim and the short one. At first the line
/// crosses once. If the parts were apart, nothing would cross the disc: both ends on long arcs as at first, and yet an
/// even number.
std::optional<SpoolCage> spool_cage(const Solid& spool, const Solid& around, double depth, const RunContext& context);

}  // namespace dismantle::verify
