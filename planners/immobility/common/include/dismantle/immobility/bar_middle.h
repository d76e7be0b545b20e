/// The middle of a bar, a wire, a wall: where balls within it are as large as possible.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility_prover.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

/// A ball within a solid. Assembled frame.
struct InnerBall {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Balls with radii above `least` (> 0) along the middle of the solid, the largest first. Some when told to stop.
std::vector<InnerBall> middle_of(const Solid& solid, double least, const RunContext& context);

/// Those of all solids of a part, as solids_of(), deeper than the query's whole tolerance: computed once in an
/// assembly. nullptr when told to stop.
const std::vector<std::vector<InnerBall>>* middles_of(const SeparationQuery& query, PartId part,
                                                      const RunContext& context);

}  // namespace dismantle::immobility
