/// Half spaces that bound what of a box is outside a solid.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "dismantle/immobility/interior_samples.h"

namespace dismantle::immobility {

struct HalfSpace {
  Eigen::Vector3d normal;  ///< unit
  double least = 0;        ///< normal . x >= least
  /// 2 k or 2 k + 1: the normal is coordinate axis k, downwards or upwards. Else less 6: the triangle that has it.
  std::uint32_t source = 0;
};

struct FreeSpaceBound {
  bool all = false;                    ///< the box does not meet the solid
  bool none = false;                   ///< the box is within the solid
  std::vector<HalfSpace> half_spaces;  ///< each holds every point of the box that is not inside the solid
};

/// The normal of a half space with that source.
Eigen::Vector3d half_space_normal(const Solid& solid, std::uint32_t source);

/// `at`, `half`: centre and half edges of the box, in the solid's frame, edges along its axes. Where a box meets very
/// many triangles nothing is said: half_spaces is empty, which is a bound too.
///
/// A linear function is least, over the free part of the box, at a corner of that: at a corner of the box that is
/// outside the solid, or at a corner of the intersection of the box and a triangle. So a few points decide.
FreeSpaceBound free_space_bound(const SampledPair::Obstacle& obstacle, const Eigen::Vector3d& at,
                                const Eigen::Vector3d& half);

}  // namespace dismantle::immobility
