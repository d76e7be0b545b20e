/// Triangles of a glTF mesh.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <vector>

#include "dismantle/mesh.h"
#include "gltf_document.h"

namespace dismantle::mesh_files {

/// Joints of a skinned vertex, and their weights.
struct Influence {
  std::size_t joint = 0;
  double weight = 0;
};

struct GltfPrimitive {
  Mesh mesh;                                       ///< morph targets applied
  std::vector<std::vector<Influence>> influences;  ///< by vertex; empty: not skinned
  std::optional<std::size_t> material;
};

struct GltfMesh {
  std::vector<GltfPrimitive> primitives;
  bool other = false;  ///< it has points or lines
};

/// `weights`: of morph targets; null or empty: those of the mesh. @throws InputError.
GltfMesh read_gltf_mesh(GltfDocument& document, const nlohmann::json& index, const nlohmann::json& weights);

}  // namespace dismantle::mesh_files
