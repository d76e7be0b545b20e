#include "gltf_mesh.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace dismantle::mesh_files {
namespace {

using Json = nlohmann::json;

class PrimitiveReader {
 public:
  PrimitiveReader(GltfDocument& document, const Json& json) : document_(document), json_(json) {}

  /// False for points and lines.
  bool read(const std::vector<double>& weights) {
    mode_ = json_.value("mode", 4);
    if (mode_ < 4 || mode_ > 6) return false;
    if (json_.contains("material")) out.material = json_["material"].get<std::size_t>();
    if (json_.contains("extensions") && json_["extensions"].contains("KHR_draco_mesh_compression"))
      read_compressed(json_["extensions"]["KHR_draco_mesh_compression"]);
    else
      read_plain();
    apply_targets(weights);
    read_influences();
    return true;
  }

  GltfPrimitive out;

 private:
  void read_plain() {
    const Json& attributes = json_.at("attributes");
    if (!attributes.contains("POSITION")) return;
    add_vertices(document_.numbers(attributes["POSITION"]));
    std::vector<std::uint32_t> corners;
    if (json_.contains("indices")) {
      const GltfNumbers numbers = document_.numbers(json_["indices"]);
      if (numbers.components != 1) document_.fail("indices of a mesh are no numbers");
      for (const double value : numbers.values) {
        if (!(value >= 0 && value < static_cast<double>(out.mesh.vertices.size())))
          document_.fail(fmt::format("a triangle names vertex {}, there are {}", value, out.mesh.vertices.size()));
        corners.push_back(static_cast<std::uint32_t>(value));
      }
    } else {
      corners.resize(out.mesh.vertices.size());
      for (std::uint32_t i = 0; i < corners.size(); ++i) corners[i] = i;
    }
    add_triangles(corners);
  }

  void add_vertices(const GltfNumbers& numbers) {
    if (numbers.components != 3) document_.fail("positions of a mesh are no vectors");
    for (std::size_t i = 0; i < numbers.count; ++i)
      out.mesh.vertices.emplace_back(numbers.at(i, 0), numbers.at(i, 1), numbers.at(i, 2));
  }

  void add_triangles(const std::vector<std::uint32_t>& corners) {
    if (mode_ == 4 && corners.size() % 3 != 0)
      document_.fail(fmt::format("{} corners of triangles are no whole triangles", corners.size()));
    const std::size_t step = mode_ == 4 ? 3 : 1;
    for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
      Triangle t{corners[i], corners[i + 1], corners[i + 2]};
      if (mode_ == 5 && i % 2 == 1) std::swap(t[1], t[2]);  // strip
      if (mode_ == 6) t = {corners[0], corners[i + 1], corners[i + 2]};
      if (mode_ == 4 || (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])) out.mesh.triangles.push_back(t);
    }
  }

  void read_compressed(const Json& extension) {
    const std::string_view bytes = document_.bytes_of_view(extension.at("bufferView"));
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
      document_.fail(fmt::format("KHR_draco_mesh_compression: {}", decoded.status().error_msg_string()));
    const draco::Mesh& mesh = *decoded.value();
    const draco::PointAttribute* positions =
        mesh.GetAttributeByUniqueId(extension.at("attributes").at("POSITION").get<std::uint32_t>());
    if (positions == nullptr) document_.fail("KHR_draco_mesh_compression: the mesh has no positions");
    for (draco::PointIndex i(0); i < mesh.num_points(); ++i) {
      std::array<float, 3> p{};
      if (!positions->ConvertValue<float, 3>(positions->mapped_index(i), p.data()))
        document_.fail("KHR_draco_mesh_compression: a position cannot be read");
      out.mesh.vertices.emplace_back(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
    }
    for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
      Triangle t{};
      for (std::size_t k = 0; k < 3; ++k) t[k] = mesh.face(f)[k].value();
      out.mesh.triangles.push_back(t);
    }
  }

  void apply_targets(const std::vector<double>& weights) {
    const Json targets = json_.value("targets", Json::array());
    for (std::size_t i = 0; i < std::min(weights.size(), targets.size()); ++i) {
      if (weights[i] == 0 || !targets[i].contains("POSITION")) continue;
      const GltfNumbers shift = document_.numbers(targets[i]["POSITION"]);
      if (shift.components != 3 || shift.count != out.mesh.vertices.size())
        document_.fail("a morph target has another number of vertices than its mesh");
      for (std::size_t v = 0; v < shift.count; ++v)
        out.mesh.vertices[v] += weights[i] * Eigen::Vector3d(shift.at(v, 0), shift.at(v, 1), shift.at(v, 2));
    }
  }

  void read_influences() {
    const Json& attributes = json_.at("attributes");
    for (int set = 0; attributes.contains(fmt::format("JOINTS_{}", set)); ++set) {
      const GltfNumbers joints = document_.numbers(attributes[fmt::format("JOINTS_{}", set)]),
                        weights = document_.numbers(attributes.at(fmt::format("WEIGHTS_{}", set)));
      if (joints.count != out.mesh.vertices.size() || weights.count != joints.count ||
          weights.components != joints.components)
        document_.fail("the joints of a mesh do not fit its vertices");
      out.influences.resize(joints.count);
      for (std::size_t v = 0; v < joints.count; ++v)
        for (std::size_t k = 0; k < joints.components; ++k)
          if (weights.at(v, k) != 0 && joints.at(v, k) >= 0)
            out.influences[v].push_back({static_cast<std::size_t>(joints.at(v, k)), weights.at(v, k)});
    }
  }

  GltfDocument& document_;
  const Json& json_;
  int mode_ = 4;
};

}  // namespace

GltfMesh read_gltf_mesh(GltfDocument& document, const Json& index, const Json& weights) {
  const Json& json = document.item("meshes", index);
  std::vector<double> used;
  if (weights.is_array() && !weights.empty())
    used = weights.get<std::vector<double>>();
  else if (json.contains("weights"))
    used = json["weights"].get<std::vector<double>>();
  GltfMesh mesh;
  for (const Json& primitive : json.at("primitives")) {
    PrimitiveReader reader(document, primitive);
    if (reader.read(used))
      mesh.primitives.push_back(std::move(reader.out));
    else
      mesh.other = true;
  }
  return mesh;
}

}  // namespace dismantle::mesh_files
