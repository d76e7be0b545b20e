/// The middle of a bar, a wire, a wall: where balls within it are as large as possible.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/run_context.h"
#include "solid.h"

namespace dismantle::verify {

/// A ball within a solid. Assembled frame.
struct InnerBall {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Balls with radii above `least` (> 0) along the middle of the solid, the largest first. Some when told to stop.
std::vector<InnerBall> middle_of(const Solid& solid, double least, const RunContext& context);

}  // namespace dismantle::verify
