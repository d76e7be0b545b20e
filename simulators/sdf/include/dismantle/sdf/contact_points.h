/// Where a part can touch another: sample points on its surface, grouped for culling.
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
  double sharp_angle = 0.5;         ///< rad; convex edges that bend more are sampled one by one
  std::size_t max_points = 60'000;  ///< the spacing grows where there would be more
};

/// Where this closed surface can touch another one first:
///  - every vertex that is a corner or lies on a curved rim or surface,
///  - points along convex edges, at most `spacing` apart on sharp edges, as dense per area elsewhere.
/// Two polyhedra that penetrate have an edge of one going through a face of the other, so vertices and
/// edges of both sides together see every contact down to the spacing. Vertices inside flat faces or on
/// straight edges or in folds, slivers and concave edges add nothing and are left out, however finely the mesh is cut.
ContactPoints sample_contact_points(const Mesh& mesh, const ContactPointOptions& options);

/// Reorders `points` into blocks.
ContactPoints make_blocks(std::vector<Eigen::Vector3d> points);

}  // namespace dismantle::sdf
