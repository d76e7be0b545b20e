/// Which points are inside of a surface that is not closed.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "dismantle/geometry/poll.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/mesh.h"

namespace dismantle::sdf {

/// Inside is where the generalised winding number is above one half, as for TriangleBvh::inside(), at a fraction of the
/// cost and without its error. Each opening gets a cap: then the winding number of the surface is that of the closed
/// one, counted along a ray, less the share of the view that the caps take. Most caps are too small or too far away to
/// matter.
class WallSides {
 public:
  explicit WallSides(const Mesh& mesh, const geometry::Poll& poll = {});
  bool inside(const Eigen::Vector3d& p) const;

 private:
  /// Triangles from the edges of one opening to a common corner.
  struct Cap {
    Eigen::Vector3d apex = Eigen::Vector3d::Zero();
    double reach = 0;  ///< largest distance of its corners from the apex
    double area = 0;
    std::size_t first = 0, end = 0;  ///< in edges_
  };
  /// The most that a cap takes of the view from p; infinity within its reach.
  static double most(const Cap& cap, const Eigen::Vector3d& p);
  double share(const Cap& cap, const Eigen::Vector3d& p) const;

  Aabb box_;  // of the surface without caps
  std::vector<Cap> caps_;
  std::vector<std::array<Eigen::Vector3d, 2>> edges_;  // by cap
  TriangleBvh closed_{Mesh{}};
};

}  // namespace dismantle::sdf
