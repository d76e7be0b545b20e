/// Balls around points of the medial axis of a solid: the middle of a bar, a wire, a wall.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility_prover.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

/// A ball within a solid that cannot grow much by a small shift. Assembled frame.
struct MedialBall {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Balls with radii above `least` (> 0), the largest first; at most one per cell of a grid with edge `least`.
/// Incomplete when told to stop.
///
/// Inner tangent balls shrink until they touch a second point of the surface (shrinking ball algorithm: Ma, Bae and
/// Choi 2012). Their centres then move to where the distance from the surface is larger.
std::vector<MedialBall> medial_balls(const Solid& solid, double least, const RunContext& context);

/// The medial balls of each solid of a part, in the order of solids_of(), that are larger than the query's whole
/// tolerance. Computed once per assembly. nullptr when told to stop.
const std::vector<std::vector<MedialBall>>* medial_balls_of(const SeparationQuery& query, PartId part,
                                                            const RunContext& context);

}  // namespace dismantle::immobility
