/// Constraints of the interior samples of two bodies on their relative pose, near the assembled one.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/immobility/interior_samples.h"

namespace dismantle::immobility {

/// normal . x <= most, of the six coordinates of SampledPair: `sample` stays beyond a plane across `direction`.
struct PairRow {
  Vector6 normal = Vector6::Zero();
  double most = 0;
  const InteriorSample* sample = nullptr;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< assembled frame
};

/// Half spaces that hold every pose between lo (< 0) and hi (> 0) at which no sample is inside its obstacle. The
/// coordinates are along `axes` (assembled = axes * ours).
///
/// How: the positions of samples are linear in the coordinates to first order about the assembled pose, with a bound of
/// the remainder by components; so each is in a box, and free_space_bound() of that box gives half spaces.
std::vector<PairRow> pair_rows(const SampledPair& pair, const Eigen::Quaterniond& axes, const Vector6& lo,
                               const Vector6& hi);

}  // namespace dismantle::immobility
