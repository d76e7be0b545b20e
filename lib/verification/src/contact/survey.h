/// Divides the surface of one part near another into cells, smallest where the two overlap.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/geometry/relative_motion.h"
#include "dismantle/geometry/solid.h"
#include "geometry_names.h"

namespace dismantle::verify {

/// Depth queries to the solids of an assembled part, in the world frame.
class Field {
 public:
  explicit Field(const std::vector<Solid>& solids);

  struct Seen {
    double depth = 0;  ///< > 0 in the deepest solid, < 0 outside: distance to its surface
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< outward, at the nearest point; zero beyond the limit
  };
  /// Returns depth -limit outside, further than `limit`.
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

/// A triangle or a piece of one, world frame.
struct SurfaceCell {
  std::array<Eigen::Vector3d, 3> p;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, outward
  Field::Seen seen;                                  ///< depth of the centre in the other part
  double radius = 0, area = 0;

  Eigen::Vector3d middle() const { return (p[0] + p[1] + p[2]) / 3; }
  bool faces() const;  ///< true if it faces the other part's surface within 45 degrees
};

/// Cells of `a` that come within `reach` of `b` or lie in it. Cells that may overlap `b` are divided further, until
/// they are as small as `finest` or a fixed number is reached.
std::vector<SurfaceCell> survey(const Field& a, const Field& b, double reach, double finest);

}  // namespace dismantle::verify
