/// Solids as one.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"

namespace dismantle::immobility {

/// All in a frame of its own: assembled = frame * local. The solids must outlive it.
class SolidUnion {
 public:
  SolidUnion(const std::vector<Solid>& solids, const Pose& frame);

  /// No solid is nearer; negative inside: all within so much is inside.
  double clearance(const Eigen::Vector3d& p) const;
  /// Is all of the box in one of the solids? No surface of that goes through a box about it.
  bool contains(const Aabb& box) const;

 private:
  struct Placed {
    const Solid* solid;
    Pose to_local;
  };
  std::vector<Placed> solids_;
};

}  // namespace dismantle::immobility
