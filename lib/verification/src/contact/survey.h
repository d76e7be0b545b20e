/// The surface of one part near another, in cells that are smallest where the two overlap.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/geometry/relative_motion.h"
#include "dismantle/geometry/solid.h"
#include "geometry_names.h"

namespace dismantle::verify {

/// The solids of a part as assembled, asked in the frame of the world.
class Field {
 public:
  explicit Field(const std::vector<Solid>& solids);

  struct Seen {
    double depth = 0;  ///< > 0 in the deepest solid, < 0 outside: distance to its surface
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< there, outward; zero beyond the limit
  };
  /// Outside and further than `limit`: -limit.
  Seen at(const Eigen::Vector3d& point, double limit) const;

  const std::vector<Solid>& solids() const { return solids_; }
  const std::vector<Placement>& to_local() const { return to_local_; }
  const std::vector<Placement>& to_world() const { return to_world_; }
  const Aabb& box() const { return box_; }  ///< around all vertices

 private:
  const std::vector<Solid>& solids_;
  std::vector<Placement> to_local_, to_world_;
  Aabb box_;
};

/// A triangle or a piece of one, in the frame of the world.
struct SurfaceCell {
  std::array<Eigen::Vector3d, 3> p;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, outward
  Field::Seen seen;                                  ///< of the other part, from the middle
  double radius = 0, area = 0;

  Eigen::Vector3d middle() const { return (p[0] + p[1] + p[2]) / 3; }
  bool faces() const;  ///< the other part's surface, within 45 degrees
};

/// Cells of `a` that come within `reach` of `b` or lie in it. Those that may overlap are divided furthest, until they
/// are as small as `finest` or a fixed number is reached.
std::vector<SurfaceCell> survey(const Field& a, const Field& b, double reach, double finest);

}  // namespace dismantle::verify
