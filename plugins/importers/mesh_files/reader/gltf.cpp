// glTF 2.0: nodes, instances, skins and visibility.
#include "gltf.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "appearance.h"
#include "dismantle/errors.h"
#include "gltf_document.h"
#include "gltf_mesh.h"
#include "input_limits.h"
#include "without_unused.h"

namespace dismantle::mesh_files {
namespace {

using Json = nlohmann::json;

/// Extensions that a file may require: what they add is read, or changes no shape.
bool extension_is_known(std::string_view name) {
  for (const char* begin : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_", "KHR_lights_",
                            "EXT_lights_", "KHR_xmp", "KHR_animation_"})
    if (name.starts_with(begin)) return true;
  for (const char* known :
       {"KHR_mesh_quantization", "EXT_mesh_gpu_instancing", "KHR_draco_mesh_compression", "KHR_node_visibility"})
    if (name == known) return true;
  return false;
}

Eigen::Matrix4d matrix_of(const Json& node) {
  Eigen::Affine3d out = Eigen::Affine3d::Identity();
  if (node.contains("matrix")) {
    const auto m = node["matrix"].get<std::vector<double>>();
    if (m.size() == 16) return Eigen::Map<const Eigen::Matrix4d>(m.data());  // by columns
    throw std::runtime_error("the matrix of a node has other than 16 numbers");
  }
  const auto vector = [&](const char* key, std::vector<double> otherwise) {
    auto v = node.value(key, otherwise);
    if (v.size() != otherwise.size()) throw std::runtime_error(fmt::format("the {} of a node is incomplete", key));
    return v;
  };
  const auto t = vector("translation", {0, 0, 0}), q = vector("rotation", {0, 0, 0, 1}), s = vector("scale", {1, 1, 1});
  out.translate(Eigen::Vector3d(t[0], t[1], t[2]));
  out.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized());
  out.scale(Eigen::Vector3d(s[0], s[1], s[2]));
  return out.matrix();
}

class GltfReader {
 public:
  explicit GltfReader(const std::filesystem::path& file) : file_(file), document_(file) {}

  PartsOfFile read() {
    for (const Json& name : document_.root().value("extensionsRequired", Json::array()))
      if (!extension_is_known(name.get<std::string>()))
        document_.fail(
            fmt::format("it requires the extension {}, which is not read: export it without", name.get<std::string>()));
    const std::size_t count = document_.root().value("nodes", Json::array()).size();
    find_parents(count);
    find_roots(count);
    seen_.resize(count);
    for (const std::size_t root : roots_) visit(root, Eigen::Matrix4d::Identity(), {}, false, 0);
    for (std::size_t i = 0; i < count; ++i)
      if (!seen_[i] && node(i).contains("mesh"))
        leave_out(name_of(i), {}, "it is in no scene that the file shows", true);
    if (out_.parts.empty()) document_.fail("no triangles");
    return std::move(out_);
  }

 private:
  const Json& node(std::size_t i) const { return document_.item("nodes", i); }

  void find_parents(std::size_t count) {
    parent_.resize(count);
    for (std::size_t i = 0; i < count; ++i)
      for (const Json& child : node(i).value("children", Json::array())) {
        const auto c = child.get<std::size_t>();
        if (c >= count) document_.fail(fmt::format("node {} has a child that does not exist", i));
        if (parent_[c]) document_.fail(fmt::format("node {} has two parents", c));
        parent_[c] = i;
      }
  }

  /// Those of the scene that the file shows; without a scene, all.
  void find_roots(std::size_t count) {
    const Json& root = document_.root();
    if (root.contains("scenes") && !root["scenes"].empty()) {
      const Json scene = document_.item("scenes", root.value("scene", Json(std::size_t{0})));
      roots_ = scene.value("nodes", std::vector<std::size_t>());
      for (const std::size_t i : roots_)
        if (i >= count) document_.fail(fmt::format("a scene has node {}, which does not exist", i));
      return;
    }
    for (std::size_t i = 0; i < count; ++i)
      if (!parent_[i]) roots_.push_back(i);
  }

  std::string name_of(std::size_t i) const {
    std::string name = node(i).value("name", "");
    if (name.empty() && node(i).contains("mesh")) name = document_.item("meshes", node(i)["mesh"]).value("name", "");
    return name;
  }

  /// Whether a node is a named assembly. A single root is the file; a node with a part's name only wraps it.
  bool groups(std::size_t i) const {
    const std::string name = node(i).value("name", "");
    if (name.empty() || node(i).contains("mesh") || (roots_.size() == 1 && roots_[0] == i)) return false;
    const Json children = node(i).value("children", Json::array());
    return children.size() > 1 || (children.size() == 1 && name != name_of(children[0].get<std::size_t>()));
  }

  static const Json* extension(const Json& json, const char* name) {
    if (!json.contains("extensions") || !json["extensions"].contains(name)) return nullptr;
    return &json["extensions"][name];
  }

  void visit(std::size_t i, const Eigen::Matrix4d& above, std::vector<std::string> parents, bool hidden,
             std::uint32_t depth) {
    if (depth > 1000 || seen_[i]) document_.fail(fmt::format("the children of node {} lead back to it", i));
    seen_[i] = true;
    const Json& here = node(i);
    const Json* visibility = extension(here, "KHR_node_visibility");
    hidden = hidden || (visibility != nullptr && !visibility->value("visible", true));
    const Eigen::Matrix4d to_world = above * matrix_of(here);
    if (here.contains("mesh")) {
      if (hidden)
        leave_out(name_of(i), parents, "it is hidden in the file", true);
      else
        add_node(i, to_world, parents);
    }
    if (groups(i)) parents.push_back(here.value("name", ""));
    for (const Json& child : here.value("children", Json::array()))
      visit(child.get<std::size_t>(), to_world, parents, hidden, depth + 1);
  }

  void leave_out(std::string name, std::vector<std::string> parents, std::string problem, bool by_meaning) {
    RawPart part;
    part.name = std::move(name);
    part.file = file_.filename().string();
    part.unit = "m";  // glTF 2.0, section 3.4
    part.parents = std::move(parents);
    part.problem = std::move(problem);
    part.by_meaning = by_meaning;
    out_.parts.push_back(std::move(part));
  }

  void add_node(std::size_t i, const Eigen::Matrix4d& to_world, const std::vector<std::string>& parents) {
    const Json& here = node(i);
    const GltfMesh mesh = read_gltf_mesh(document_, here["mesh"], here.value("weights", Json()));
    RawPart part;
    part.name = name_of(i);
    part.file = file_.filename().string();
    part.unit = "m";
    part.parents = parents;
    OneColour colour;
    for (const GltfPrimitive& primitive : mesh.primitives) {
      append(primitive.mesh, part.mesh);
      colour.add(primitive.material ? colour_of(*primitive.material) : std::nullopt);
    }
    part.colour = colour.get();
    if (part.mesh.triangles.empty())
      return leave_out(part.name, parents, mesh.other ? "only points or lines" : "it has no triangles", mesh.other);
    if (here.contains("skin")) {
      // The place of the node itself does not count: joints place a skinned mesh.
      if (extension(here, "EXT_mesh_gpu_instancing") != nullptr)
        document_.fail(fmt::format("'{}' has a skin and instances, which is not allowed", part.name));
      pose(here["skin"], mesh, part.mesh);
      add(std::move(part), Eigen::Matrix4d::Identity());
    } else if (const Json* instances = extension(here, "EXT_mesh_gpu_instancing")) {
      const std::vector<Eigen::Matrix4d> places = instances_of(instances->at("attributes"));
      if (places.empty()) leave_out(part.name, parents, "it has no instances", false);
      for (const Eigen::Matrix4d& instance : places) add(part, to_world * instance);
    } else {
      add(std::move(part), to_world);
    }
  }

  static void append(const Mesh& from, Mesh& to) {
    const auto base = static_cast<std::uint32_t>(to.vertices.size());
    to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
    for (const Triangle& t : from.triangles) to.triangles.push_back({base + t[0], base + t[1], base + t[2]});
  }

  std::optional<Rgba> colour_of(std::size_t material) const {
    const Json factor = document_.item("materials", material)
                            .value("pbrMetallicRoughness", Json::object())
                            .value("baseColorFactor", Json({1.0, 1.0, 1.0, 1.0}));
    const auto c = factor.get<std::vector<double>>();
    return c.size() == 4 ? rgba(c[0], c[1], c[2], c[3], true) : std::nullopt;
  }

  /// Moves each vertex with its joints.
  void pose(const Json& index, const GltfMesh& mesh, Mesh& whole) {
    const Json& skin = document_.item("skins", index);
    const auto joints = skin.at("joints").get<std::vector<std::size_t>>();
    std::vector<Eigen::Matrix4d> matrices;
    std::optional<GltfNumbers> inverse;
    if (skin.contains("inverseBindMatrices")) inverse = document_.numbers(skin["inverseBindMatrices"]);
    if (inverse && (inverse->components != 16 || inverse->count < joints.size()))
      document_.fail("a skin has fewer matrices than joints");
    for (std::size_t j = 0; j < joints.size(); ++j) {
      matrices.push_back(world_of(joints[j]));
      if (inverse) matrices.back() *= Eigen::Map<const Eigen::Matrix4d>(&inverse->values[16 * j]);
    }
    std::size_t v = 0;
    for (const GltfPrimitive& primitive : mesh.primitives) {
      if (primitive.influences.empty() && !primitive.mesh.vertices.empty())
        document_.fail("a mesh with a skin has vertices without joints");
      for (const auto& influences : primitive.influences) {
        Eigen::Vector4d moved = Eigen::Vector4d::Zero();
        double sum = 0;
        for (const Influence& influence : influences) {
          if (influence.joint >= matrices.size()) document_.fail("a vertex names a joint that its skin has not");
          moved += influence.weight * (matrices[influence.joint] * whole.vertices[v].homogeneous());
          sum += influence.weight;
        }
        if (!(sum > 0)) document_.fail("a vertex of a mesh with a skin has no weights");
        whole.vertices[v++] = moved.head<3>() / sum;
      }
    }
  }

  Eigen::Matrix4d world_of(std::size_t i) const {
    Eigen::Matrix4d out = matrix_of(node(i));
    std::size_t steps = 0;
    for (auto above = parent_.at(i); above; above = parent_[*above]) {
      out = matrix_of(node(*above)) * out;
      if (++steps > parent_.size()) document_.fail("a joint is its own parent");
    }
    return out;
  }

  std::vector<Eigen::Matrix4d> instances_of(const Json& attributes) {
    std::map<std::string, GltfNumbers> read;
    std::optional<std::size_t> count;
    for (const auto& [name, accessor] : attributes.items())  // others than these say how many there are, too
      if (!count) count = document_.numbers(accessor).count;
    for (const auto& [name, components] :
         {std::pair{"TRANSLATION", 3U}, std::pair{"ROTATION", 4U}, std::pair{"SCALE", 3U}}) {
      if (!attributes.contains(name)) continue;
      const GltfNumbers& numbers = read[name] = document_.numbers(attributes[name]);
      if (numbers.components != components || (count && *count != numbers.count))
        document_.fail("the attributes of instances do not fit each other");
      count = numbers.count;
    }
    std::vector<Eigen::Matrix4d> out;
    for (std::size_t i = 0; i < count.value_or(0); ++i) {
      Json place = Json::object();
      for (const auto& [name, key] :
           {std::pair{"TRANSLATION", "translation"}, std::pair{"ROTATION", "rotation"}, std::pair{"SCALE", "scale"}})
        if (const auto found = read.find(name); found != read.end())
          for (std::size_t k = 0; k < found->second.components; ++k) place[key].push_back(found->second.at(i, k));
      out.push_back(matrix_of(place));
    }
    return out;
  }

  void add(RawPart part, const Eigen::Matrix4d& to_world) {
    const Eigen::Matrix3d linear = to_world.topLeftCorner<3, 3>();
    if (linear.isZero(0)) return leave_out(part.name, part.parents, "it is hidden by a scale of zero", true);
    if (linear.determinant() == 0) return leave_out(part.name, part.parents, "its place flattens it", false);
    part.mesh = without_unused(part.mesh);
    total_ += part.mesh.triangles.size();
    if (total_ > reader_process::kInputLimits.triangles || out_.parts.size() >= reader_process::kInputLimits.instances)
      document_.fail(fmt::format("more than {} triangles or {} nodes", reader_process::kInputLimits.triangles,
                                 reader_process::kInputLimits.instances));
    for (std::size_t v = 0; v < part.mesh.vertices.size(); ++v) {
      Eigen::Vector3d& p = part.mesh.vertices[v];
      p = (to_world * p.homogeneous()).head<3>();
      if (!p.allFinite()) document_.fail(fmt::format("part '{}': vertex {} is not finite", part.name, v + 1));
    }
    if (to_world.topLeftCorner<3, 3>().determinant() < 0)
      for (Triangle& t : part.mesh.triangles) std::swap(t[1], t[2]);
    out_.parts.push_back(std::move(part));
  }

  const std::filesystem::path& file_;
  GltfDocument document_;
  std::vector<std::optional<std::size_t>> parent_;
  std::vector<std::size_t> roots_;
  std::vector<bool> seen_;
  PartsOfFile out_;
  std::size_t total_ = 0;
};

}  // namespace

PartsOfFile read_gltf(const std::filesystem::path& file) {
  try {
    return GltfReader(file).read();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw InputError(file.string(), fmt::format("cannot be read: {}", e.what()));
  }
}

}  // namespace dismantle::mesh_files
