/// Distance and containment queries against a union of solids.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"

namespace dismantle::immobility {

/// Queries are in a frame of its own: assembled = frame * local. The solids must outlive it.
class SolidUnion {
 public:
  SolidUnion(const std::vector<Solid>& solids, const Pose& frame);

  /// A lower bound of the distance to the solids; negative inside: the ball of that radius is inside a solid.
  double clearance(const Eigen::Vector3d& p) const;
  /// Is all of the box in one solid? Only true if that solid's surface does not even meet the box's bounding box in the
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
