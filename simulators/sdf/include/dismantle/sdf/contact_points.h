/// Sample points on the surface of a part at which it can touch another, grouped for culling.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "dismantle/mesh.h"

namespace dismantle::sdf {

struct PointBlock {
  std::uint32_t first = 0, count = 0;  ///< range in ContactPoints::points
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

struct ContactPoints {
  std::vector<Eigen::Vector3d> points;  ///< block by block
  std::vector<PointBlock> blocks;       ///< at most kBlockSize points each
  static constexpr std::uint32_t kBlockSize = 16;
};

struct ContactPointOptions {
  double spacing = 0.1;             ///< along sharp edges and over smooth surfaces, assembly units, > 0
  double sharp_angle = 0.5;         ///< rad; convex edges with a larger bend count as sharp
  std::size_t max_points = 60'000;  ///< the spacing grows if there would be more
};

/// Points at which this closed surface can first touch another one:
///  - every vertex that is a corner or lies on a curved rim or surface,
///  - points along convex edges, at most `spacing` apart on sharp edges, as dense per area elsewhere.
/// Two polyhedra that penetrate have an edge of one going through a face of the other, so vertices and edges of both
/// parts find every contact down to the spacing. Vertices inside flat faces, on straight edges or in folds, slivers and
/// concave edges add nothing and are omitted, however fine the mesh is.
ContactPoints sample_contact_points(const Mesh& mesh, const ContactPointOptions& options);

/// Reorders `points` into blocks.
ContactPoints make_blocks(std::vector<Eigen::Vector3d> points);

}  // namespace dismantle::sdf
