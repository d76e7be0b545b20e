/// Constraints of the interior samples of two bodies on their relative pose, near the assembled one.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/immobility/interior_samples.h"

namespace dismantle::immobility {

/// normal . x <= most in the six coordinates of SampledPair: `sample` stays beyond a plane across `direction`.
struct PairRow {
  Vector6 normal = Vector6::Zero();
  double most = 0;
  const InteriorSample* sample = nullptr;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< assembled frame
};

/// Half spaces that contain every pose between lo (< 0) and hi (> 0) at which no sample is inside its obstacle. The
/// coordinates are along `axes` (assembled = axes * local).
///
/// About the assembled pose, the position of a sample is linear in the coordinates up to a remainder that is bounded by
/// component. So the sample is in a box, and free_space_bound() of that box gives half spaces.
std::vector<PairRow> pair_rows(const SampledPair& pair, const Eigen::Quaterniond& axes, const Vector6& lo,
                               const Vector6& hi);

}  // namespace dismantle::immobility
