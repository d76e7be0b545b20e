/// The geometry of DAE files.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "dismantle/mesh.h"
#include "xml_tree.h"

namespace dismantle::mesh_files {

struct DaeMesh {
  /// Triangles of one material.
  struct Group {
    std::string material;  ///< symbol that the use of the geometry binds
    std::vector<Triangle> triangles;
  };
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Group> groups;
  bool drawn = false;   ///< it has lines or splines
  std::string problem;  ///< not empty: why it, or a part of it, is not read

  bool has_triangles() const;
};

/// Reads a <geometry>.
/// @throws InputError of the file, through `fail`, where numbers are missing, too many, or no numbers.
DaeMesh read_dae_mesh(const XmlElement& geometry, const std::function<void(const std::string&)>& fail);

/// Numbers of a text. @throws as above.
std::vector<double> dae_numbers(const XmlElement& element, const std::function<void(const std::string&)>& fail);

}  // namespace dismantle::mesh_files
