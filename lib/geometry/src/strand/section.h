/// Cuts a closed mesh with a plane, near a point.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/mesh.h"

namespace dismantle::geometry {

/// The piece of a cut that a point lies in.
struct Section {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< centroid
  double area = 0, outline = 0;
  std::vector<Eigen::Vector3d> rim;  ///< corners, counter-clockwise about the normal
};

/// The piece around `point` of the cut through it, square to the unit vector `normal`, as far as triangles come within
/// `reach` of the point: none where the piece does not end there. Holes are part of it.
std::optional<Section> section_around(const Mesh& mesh, const TriangleBvh& bvh, const Eigen::Vector3d& point,
                                      const Eigen::Vector3d& normal, double reach);

}  // namespace dismantle::geometry
