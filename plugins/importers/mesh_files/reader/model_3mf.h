/// One .model file of a 3MF archive.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "appearance.h"
#include "zip_archive.h"
#include "dismantle/mesh.h"

namespace dismantle::mesh_files {

/// An object at a place: a component of another object, or a build item.
struct Placed3mf {
  std::string object;  ///< id
  std::string path;    ///< the model file that holds it, without leading slash; empty: the same
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
};

struct Object3mf {
  std::string name, type;
  Mesh mesh;
  OneColour colour;
  std::vector<Placed3mf> components;
  bool beams = false;  ///< its mesh has a lattice of beams
};

struct Model3mf {
  std::string unit = "mm";                   ///< name in length_unit.h
  std::map<std::string, Object3mf> objects;  ///< by id
  std::vector<std::string> order;            ///< ids, as in the file
  std::vector<Placed3mf> items;
};

/// Reads `name`. XML in any encoding that it may have, with any prefixes.
/// @throws InputError for damaged XML with its line, and for a required extension that changes shapes and is not read.
Model3mf read_model_3mf(reader_process::ZipArchive& archive, const std::filesystem::path& file,
                        const std::string& name);

/// The target of the relationship whose type ends with `type` in a .rels file; empty when there is none.
std::string target_3mf(reader_process::ZipArchive& archive, const std::filesystem::path& file, const std::string& rels,
                       const std::string& type);

}  // namespace dismantle::mesh_files
