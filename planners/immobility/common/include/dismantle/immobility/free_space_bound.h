/// Half spaces that bound the part of a box outside a solid.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "dismantle/immobility/interior_samples.h"

namespace dismantle::immobility {

struct HalfSpace {
  Eigen::Vector3d normal;  ///< unit
  double least = 0;        ///< normal . x >= least
  /// Below 6: the normal is the negative (2 k) or positive (2 k + 1) coordinate axis k. Else 6 + index of its triangle.
  std::uint32_t source = 0;
};

struct FreeSpaceBound {
  bool all = false;                    ///< the box does not meet the solid
  bool none = false;                   ///< the box is within the solid
  std::vector<HalfSpace> half_spaces;  ///< each contains every point of the box that is not inside the solid
};

/// The normal of a half space with that source.
Eigen::Vector3d half_space_normal(const Solid& solid, std::uint32_t source);

/// `at`, `half`: centre and half edges of the box, in the solid's frame, along its axes. If the box meets very many
/// triangles, half_spaces is empty, which is also a valid bound.
///
/// Over the free part of the box, a linear function is least at a corner: a corner of the box that is outside the
/// solid, or a corner of the intersection of the box and a triangle. So only these points are evaluated.
FreeSpaceBound free_space_bound(const SampledPair::Obstacle& obstacle, const Eigen::Vector3d& at,
                                const Eigen::Vector3d& half);

}  // namespace dismantle::immobility
