/// Proof that a ring of one part cannot leave a chamber of another.
#pragma once

#include <optional>
#include <vector>

#include "dismantle/immobility/interior_circle.h"
#include "dismantle/run_context.h"
#include "ring/ring.h"

namespace dismantle::immobility {

struct RingCage {
  InteriorCircle circle;
  std::vector<double> planes;  ///< offsets along the circle's axis of the planes of the openings
  double opening = 0;          ///< diameter of the largest opening of the chamber; < 2 * circle.radius
};

/// Large circles in the solid, at least `depth` (> 0) below its surface; the largest first.
std::vector<InteriorCircle> circles_in(const Solid& solid, double depth, const RingParameters& params);

/// Proves that the circle is in a chamber of the solid that it cannot leave. Returns nullopt if no such chamber was
/// found, or told to stop. `slack`: openings are narrower than the circle by more than this; assembly units, > 0.
///
/// Why it cannot leave: the surface of the solid never meets the circle, since it would be deeper in the circle's part
/// than is allowed. The chamber is closed by a piece of that surface and by flat discs whose borders are curves on the
/// surface. So the circle can leave only through discs. It is not linked with the border of a disc at first, and hence
/// never, so it crosses the disc in two points or none. The chord between the two points is shorter than the circle's
/// diameter, so one of the arcs is shorter than half of the circle. This is the arc that was cut off when the circle
/// first touched the disc, and it never grows to half of the circle. When the circle crosses no disc, no arc is cut
/// off, and all of it is inside again. So a point of the circle is always in the chamber or on one of its discs.
std::optional<RingCage> ring_cage(const InteriorCircle& circle, const Solid& around, double slack,
                                  const RingParameters& params, const RunContext& context);

}  // namespace dismantle::immobility
