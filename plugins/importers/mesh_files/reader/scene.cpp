#include "scene.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <assimp/Importer.hpp>
#include <cmath>
#include <string_view>

#include "appearance.h"
#include "dismantle/errors.h"
#include "dismantle/referenced_file.h"
#include "input_limits.h"
#include "names_3mf.h"

namespace dismantle::mesh_files {
namespace {

Eigen::Matrix4d matrix(const aiMatrix4x4& m) {
  Eigen::Matrix4d out;
  out << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return out;
}

/// The base colour of a material; nothing for the one that assimp makes up where a file has none.
std::optional<Rgba> colour_of(const aiMaterial& material, bool linear) {
  aiString name;
  if (material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS &&
      std::string_view(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME)
    return std::nullopt;
  aiColor4D colour;
  if (material.Get(AI_MATKEY_BASE_COLOR, colour) != aiReturn_SUCCESS &&
      material.Get(AI_MATKEY_COLOR_DIFFUSE, colour) != aiReturn_SUCCESS)
    return std::nullopt;
  return rgba(static_cast<double>(colour.r), static_cast<double>(colour.g), static_cast<double>(colour.b),
              static_cast<double>(colour.a), linear);
}

/// Opens the file itself, and of those that it names the ones that may_read_referenced() allows.
class ReferencedFiles : public Assimp::DefaultIOSystem {
 public:
  /// `refused`: the last one that was not opened for this reason.
  ReferencedFiles(std::filesystem::path file, std::string& refused) : file_(std::move(file)), refused_(refused) {}
  bool Exists(const char* name) const override { return may_be_read(name) && DefaultIOSystem::Exists(name); }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    return may_be_read(name) ? DefaultIOSystem::Open(name, mode) : nullptr;
  }

 private:
  bool may_be_read(const char* name) const {
    if (file_ == name || may_read_referenced(name, file_)) return true;
    refused_ = name;
    return false;
  }

  std::filesystem::path file_;
  std::string& refused_;
};

/// Without vertices that no triangle has: those of points and lines.
Mesh without_unused(const Mesh& mesh) {
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

class SceneReader {
 public:
  /// `linear`: colours are linear light.
  SceneReader(const std::filesystem::path& file, const aiScene& scene, bool linear)
      : file_(file), scene_(scene), linear_(linear) {}

  std::vector<RawPart> read(bool ignore_root_transform) {
    struct Visit {
      const aiNode* node;
      Eigen::Matrix4d above;
      std::vector<std::string> parents;
    };
    std::vector<Visit> pending{{scene_.mRootNode, Eigen::Matrix4d::Identity(), {}}};
    std::size_t visited = 0;
    while (!pending.empty()) {
      const Visit visit = pending.back();
      pending.pop_back();
      if (++visited > reader_process::kInputLimits.instances)
        fail(fmt::format("more than {} nodes", reader_process::kInputLimits.instances));
      Eigen::Matrix4d to_world = visit.above;
      if (visit.node != scene_.mRootNode || !ignore_root_transform) to_world *= matrix(visit.node->mTransformation);
      add(*visit.node, to_world, visit.parents);
      std::vector<std::string> path = visit.parents;
      if (groups(*visit.node)) path.emplace_back(visit.node->mName.C_Str());
      for (unsigned i = visit.node->mNumChildren; i-- > 0;)
        pending.push_back({visit.node->mChildren[i], to_world, path});
    }
    if (parts_.empty()) fail(other_primitives_ ? "only points or lines, no triangles" : "no triangles");
    return std::move(parts_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const { throw InputError(file_.string(), problem); }

  /// Is the node an assembly that people named? The root is the file; what has a part's name, or one that assimp made
  /// up, is a wrapper around a transform.
  bool groups(const aiNode& node) const {
    const std::string_view name = node.mName.C_Str();
    if (&node == scene_.mRootNode || name.empty() || node.mNumMeshes > 0 || name[0] == '$' || name[0] == '<')
      return false;
    return node.mNumChildren > 1 || (node.mNumChildren == 1 && name != node.mChildren[0]->mName.C_Str());
  }

  /// All meshes of one node are one part: formats split them by material only.
  void add(const aiNode& node, const Eigen::Matrix4d& to_world, const std::vector<std::string>& parents) {
    RawPart part;
    part.parents = parents;
    OneColour colour;
    part.name = node.mName.C_Str();
    part.file = file_.filename().string();
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[i]];
      if (part.name.empty()) part.name = mesh.mName.C_Str();
      append(mesh, to_world, part);
      colour.add(mesh.mMaterialIndex < scene_.mNumMaterials
                     ? colour_of(*scene_.mMaterials[mesh.mMaterialIndex], linear_)
                     : std::nullopt);
    }
    part.colour = colour.get();
    if (part.mesh.empty()) return;
    if (other_primitives_) part.mesh = without_unused(part.mesh);
    total_ += part.mesh.triangles.size();
    if (total_ > reader_process::kInputLimits.triangles)
      fail(fmt::format("more than {} triangles", reader_process::kInputLimits.triangles));
    parts_.push_back(std::move(part));
  }

  void append(const aiMesh& mesh, const Eigen::Matrix4d& to_world, RawPart& part) {
    const auto base = static_cast<std::uint32_t>(part.mesh.vertices.size());
    const Eigen::Matrix3d linear = to_world.topLeftCorner<3, 3>();
    const Eigen::Vector3d shift = to_world.topRightCorner<3, 1>();
    const bool mirrored = linear.determinant() < 0;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const Eigen::Vector3d local(static_cast<double>(mesh.mVertices[v].x), static_cast<double>(mesh.mVertices[v].y),
                                  static_cast<double>(mesh.mVertices[v].z));
      part.mesh.vertices.push_back(linear * local + shift);
      if (!part.mesh.vertices.back().allFinite())
        fail(fmt::format("part '{}': vertex {} is not finite", part.name, v + 1));
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) {
        other_primitives_ = true;
        continue;
      }
      Triangle t;
      for (std::size_t k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices)
          fail(fmt::format("part '{}': face {} names vertex {} of {}", part.name, f + 1, face.mIndices[k] + 1,
                           mesh.mNumVertices));
        t[k] = base + face.mIndices[k];
      }
      if (mirrored) std::swap(t[1], t[2]);
      part.mesh.triangles.push_back(t);
    }
  }

  const std::filesystem::path& file_;
  const aiScene& scene_;
  const bool linear_;
  std::vector<RawPart> parts_;
  std::size_t total_ = 0;
  bool other_primitives_ = false;
};

}  // namespace

std::vector<RawPart> read_scene(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  try {
    std::string refused;
    Assimp::Importer importer;
    importer.SetIOHandler(new ReferencedFiles(file, refused));  // the importer owns it
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
    const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate);
    if (!scene || !scene->mRootNode) {
      const std::string why = importer.GetErrorString();
      if (!refused.empty())
        throw InputError(file.string(), fmt::format("it names '{}', which is no file in its folder", refused));
      if (why.find("bad_alloc") != std::string::npos) throw std::bad_alloc();  // caught by assimp
      // What assimp says of a file whose begin it does not recognise.
      if (why.starts_with("No suitable reader found") || why.starts_with("Failed to open file"))
        throw InputError(file.string(), fmt::format("this is no {} file, or it is cut off", ending));
      throw InputError(file.string(), "cannot be read: " + (why.empty() ? "no scene in it" : why));
    }
    // What assimp puts into the root node of a DAE scene is a conversion to metres: parts keep the units of their file.
    const bool is_gltf = ending == ".glb" || ending == ".gltf";
    std::vector<RawPart> parts = SceneReader(file, *scene, is_gltf).read(ending == ".dae");
    std::string unit;
    if (is_gltf) unit = "m";  // glTF 2.0, section 3.4
    if (ending == ".dae")
      unit = unit_of_length(matrix(scene->mRootNode->mTransformation).topLeftCorner<3, 3>().col(0).norm());
    if (ending == ".3mf") {
      const Facts3mf facts = facts_of_3mf(file);
      unit = facts.unit;
      // assimp calls them "Object_" and their id.
      const auto rename = [&](std::string& name) {
        if (const auto found = facts.names.find(name.substr(name.find('_') + 1)); found != facts.names.end())
          name = found->second;
      };
      for (auto& part : parts) {
        rename(part.name);
        for (auto& parent : part.parents) rename(parent);
      }
    }
    for (auto& part : parts) part.unit = unit;
    return parts;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw InputError(file.string(), fmt::format("cannot be read: {}", e.what()));
  }
}

}  // namespace dismantle::mesh_files
