/// Distance and containment queries against a union of solids.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"

namespace dismantle::immobility {

/// Queries are in a local frame: assembled = frame * local. The solids must outlive it.
class SolidUnion {
 public:
  SolidUnion(const std::vector<Solid>& solids, const Pose& frame);

  /// A lower bound of the distance to the solids. Negative inside: the ball of that radius is then inside a solid.
  double clearance(const Eigen::Vector3d& p) const;
  /// True if the box is in one solid. Conservative: the solid's surface must not meet the box's bounding box in the
  /// solid's frame.
  bool contains(const Aabb& box) const;

 private:
  struct Placed {
    const Solid* solid;
    Pose to_local;
  };
  std::vector<Placed> solids_;
};

}  // namespace dismantle::immobility
