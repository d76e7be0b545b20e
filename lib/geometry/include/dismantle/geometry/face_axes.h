/// The directions along which the faces of a mesh look.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/mesh.h"

namespace dismantle::geometry {

/// The cross product of two edges: along the outward normal, twice the area long.
inline Eigen::Vector3d area_vector(const std::array<Eigen::Vector3d, 3>& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
}
/// Normal of the triangle times its area.
inline Eigen::Vector3d area_vector(const Mesh& mesh, std::size_t triangle) {
  const Eigen::Vector3d& a = mesh.vertex(triangle, 0);
  return (mesh.vertex(triangle, 1) - a).cross(mesh.vertex(triangle, 2) - a);
}

/// A line along which faces look, either way.
struct FaceAxis {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< unit; its sign means nothing
  double area = 0;                                 ///< of those faces, or what the caller weighs them by
};

/// Joins a face to the first axis that is as near as `same` (cosine of the angle); else it becomes an axis of its own,
/// where there are not `most` yet.
DISMANTLE_API void add_face(std::vector<FaceAxis>& axes, const FaceAxis& face, double same,
                            std::size_t most = std::numeric_limits<std::size_t>::max());

/// Most area first; equals stay in their order. Drops what comes after the first `most`.
DISMANTLE_API void sort_by_area(std::vector<FaceAxis>& axes,
                                std::size_t most = std::numeric_limits<std::size_t>::max());

/// Joins faces whose normals agree to three decimals, up to their sign; the first of them stands for the axis. Faster
/// than add_face() where there are thousands, and which axes come out depends less on the order. Ordered by direction.
DISMANTLE_API std::vector<FaceAxis> rounded_axes(const std::vector<FaceAxis>& faces);

}  // namespace dismantle::geometry
