/// Planar cut of a closed mesh near a point.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/mesh.h"

namespace dismantle::geometry {

/// The piece of a cut that contains a given point.
struct Section {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< centroid
  double area = 0, outline = 0;
  std::vector<Eigen::Vector3d> rim;  ///< corners, counter-clockwise about the normal
};

/// The piece around `point` of the cut through it, perpendicular to the unit vector `normal`. Uses triangles within
/// `reach` of the point; none if the outline does not close there. Holes belong to the piece.
std::optional<Section> section_around(const Mesh& mesh, const TriangleBvh& bvh, const Eigen::Vector3d& point,
                                      const Eigen::Vector3d& normal, double reach);

}  // namespace dismantle::geometry
