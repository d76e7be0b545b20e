/// Axes of the face normals of a mesh.
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

/// Cross product of two edges: the outward normal times twice the area.
inline Eigen::Vector3d area_vector(const std::array<Eigen::Vector3d, 3>& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
}
/// The same for one triangle of a mesh.
inline Eigen::Vector3d area_vector(const Mesh& mesh, std::size_t triangle) {
  const Eigen::Vector3d& a = mesh.vertex(triangle, 0);
  return (mesh.vertex(triangle, 1) - a).cross(mesh.vertex(triangle, 2) - a);
}

/// Common axis of face normals.
struct FaceAxis {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< unit; the sign has no meaning
  double area = 0;                                 ///< of these faces, or another weight that the caller chose
};

/// Adds a face to the first axis within the angle whose cosine is `same`. Without such an axis, the face becomes a new
/// one unless there are `most` already.
DISMANTLE_API void add_face(std::vector<FaceAxis>& axes, const FaceAxis& face, double same,
                            std::size_t most = std::numeric_limits<std::size_t>::max());

/// Sorts by descending area (stable) and keeps the first `most` axes.
DISMANTLE_API void sort_by_area(std::vector<FaceAxis>& axes,
                                std::size_t most = std::numeric_limits<std::size_t>::max());

/// Joins faces whose normals agree to three decimals, up to sign; the first normal becomes the axis. With thousands of
/// faces this is faster than add_face(), and the axes depend less on the order of faces. Ordered by direction.
DISMANTLE_API std::vector<FaceAxis> rounded_axes(const std::vector<FaceAxis>& faces);

/// Axes of the faces of a mesh as rounded_axes() joins them, largest area first, at most `most`. FaceAxis::area: twice
/// the area.
DISMANTLE_API std::vector<FaceAxis> largest_face_axes(const Mesh& mesh, std::size_t most);

}  // namespace dismantle::geometry
