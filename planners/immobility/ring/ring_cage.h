/// A ring of one part in a chamber of another, all of whose openings are too small for it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dismantle/immobility/inner_ring.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

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

}  // namespace dismantle::immobility
