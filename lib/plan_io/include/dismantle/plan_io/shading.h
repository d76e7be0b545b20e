/// Triangles for display: single precision, with normals.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <numbers>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/mesh.h"

namespace dismantle {

/// One entry per corner that needs a position or normal of its own.
struct ShadedMesh {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;  ///< unit
  std::vector<std::uint32_t> indices;    ///< three per triangle
};

/// Triangles that share an edge and meet at less than `crease_angle` (rad) share a normal along it, so that
/// cylinders look round and boxes keep their edges. Triangles without area are left out.
DISMANTLE_API ShadedMesh shade(const Mesh& mesh, double crease_angle = std::numbers::pi / 6);

}  // namespace dismantle
