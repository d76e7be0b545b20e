/// Triangle surface of one part.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "dismantle/aabb.h"

namespace dismantle {

/// Indices of three vertices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// Indexed triangles with shared vertices; counter-clockwise seen from outside.
/// After preparation every mesh is closed: each directed edge is matched by its opposite. A mesh may
/// consist of several closed shells (voids, inserts); the part is then the union of its solid shells.
struct Mesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;

  bool empty() const { return triangles.empty(); }
  const Eigen::Vector3d& vertex(std::size_t triangle, int corner) const {
    return vertices[triangles[triangle][static_cast<std::size_t>(corner)]];
  }
  /// Box of all vertices; empty box for a mesh without vertices.
  Aabb box() const {
    Aabb b;
    for (const auto& v : vertices) b.extend(v);
    return b;
  }
};

}  // namespace dismantle
