/// What is left of a box outside a solid: half spaces that hold it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/immobility/pins.h"

namespace dismantle::immobility {

struct HalfSpace {
  Eigen::Vector3d normal;  ///< unit
  double least = 0;        ///< normal . x >= least
};

struct FreePart {
  bool all = false;               ///< the box does not meet the solid
  bool none = false;              ///< the box is within the solid
  std::vector<HalfSpace> within;  ///< each holds every point of the box that is not inside the solid
};

/// `at`, `half`: the box, in the solid's frame, edges along its axes.
///
/// A linear function is least, over what is left of the box, at a corner of that: at a corner of the box that is
/// outside, or at a corner of what the box cuts out of a triangle. So few points decide.
FreePart free_part(const Pinned::Faced& faced, const Eigen::Vector3d& at, const Eigen::Vector3d& half);

}  // namespace dismantle::immobility
