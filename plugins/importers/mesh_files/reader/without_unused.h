/// Vertices that triangles use.
#pragma once

#include <cstdint>
#include <vector>

#include "dismantle/mesh.h"

namespace dismantle::mesh_files {

/// The mesh without vertices that no triangle uses. Vertices are in the order of their first use.
inline Mesh without_unused(const Mesh& mesh) {
  Mesh used;
  const auto unused = static_cast<std::uint32_t>(-1);
  std::vector<std::uint32_t> number(mesh.vertices.size(), unused);
  for (Triangle t : mesh.triangles) {
    for (auto& corner : t) {
      if (number[corner] == unused) {
        number[corner] = static_cast<std::uint32_t>(used.vertices.size());
        used.vertices.push_back(mesh.vertices[corner]);
      }
      corner = number[corner];
    }
    used.triangles.push_back(t);
  }
  return used;
}

}  // namespace dismantle::mesh_files
