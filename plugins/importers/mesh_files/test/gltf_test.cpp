// glTF files made here: required extensions, instances, quantised positions, skins, morph targets, hidden nodes.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/run_context.h"
#include "mesh_files.h"
#include "test/fixtures.h"

namespace dismantle::mesh_files {
namespace {

using Json = nlohmann::json;
using testing::expect_box;
using testing::input_error;
using testing::TempFolder;

/// A GLB file under construction: one mesh, a box from the origin, of float positions.
class Glb {
 public:
  explicit Glb(const Eigen::Vector3d& size = {1, 2, 3}) {
    json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
    const Mesh box = testing::box({0, 0, 0}, size);
    std::vector<float> positions;
    for (const auto& v : box.vertices)
      for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(v[k]));
    std::vector<std::uint16_t> corners;
    for (const auto& t : box.triangles)
      corners.insert(corners.end(), {std::uint16_t(t[0]), std::uint16_t(t[1]), std::uint16_t(t[2])});
    vertices = box.vertices.size();
    const int p = add(positions, 5126, "VEC3"), i = add(corners, 5123, "SCALAR");
    json["meshes"] = {{{"name", "box"}, {"primitives", {{{"attributes", {{"POSITION", p}}}, {"indices", i}}}}}};
  }

  template <class T>
  int add(const std::vector<T>& values, int type, const std::string& shape) {
    const std::size_t width = shape == "SCALAR" ? 1 : shape == "MAT4" ? 16 : static_cast<std::size_t>(shape[3] - '0');
    while (data.size() % 4 != 0) data += '\0';
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", values.size() * sizeof(T)}});
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", type},
                                 {"count", values.size() / width},
                                 {"type", shape}});
    data.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  void require(const std::string& extension) {
    json["extensionsUsed"].push_back(extension);
    json["extensionsRequired"].push_back(extension);
  }

  std::string bytes() const {
    Json whole = json;
    std::string binary = data;
    while (binary.size() % 4 != 0) binary += '\0';
    whole["buffers"] = {{{"byteLength", binary.size()}}};
    std::string text = whole.dump();
    while (text.size() % 4 != 0) text += ' ';
    const auto word = [](std::size_t n) {
      const auto value = static_cast<std::uint32_t>(n);
      return std::string(reinterpret_cast<const char*>(&value), 4);
    };
    return "glTF" + word(2) + word(28 + text.size() + binary.size()) + word(text.size()) + "JSON" + text +
           word(binary.size()) + std::string("BIN\0", 4) + binary;
  }

  std::vector<RawPart> read() const { return MeshFiles().read(folder.write("a.glb", bytes()), {}); }
  std::string error() const {
    return input_error([&] { read(); });
  }

  Json json;
  std::string data;
  std::size_t vertices = 0;
  TempFolder folder;
};

TEST(Gltf, ARequiredExtensionThatIsNotReadIsNamed) {
  for (const char* name : {"EXT_meshopt_compression", "ACME_mystery", "KHR_implicit_shapes"}) {
    Glb glb;
    glb.require(name);
    EXPECT_NE(glb.error().find(std::string("requires the extension ") + name), std::string::npos) << glb.error();
  }
  Glb plain;
  plain.require("KHR_materials_unlit");
  ASSERT_EQ(plain.read().size(), 1u) << "it changes no shape";
  Glb compressed;  // not required, but its only data are compressed
  compressed.json["bufferViews"][0]["buffer"] = 1;
  compressed.json["buffers"] = Json::array();
  EXPECT_NE(compressed.error(), "");
}

TEST(Gltf, InstancesAreParts) {
  for (const bool required : {true, false}) {
    Glb glb;
    if (required) glb.require("EXT_mesh_gpu_instancing");
    const int t = glb.add(std::vector<float>{0, 0, 0, 10, 0, 0, 0, 10, 0}, 5126, "VEC3");
    const int s = glb.add(std::vector<float>{1, 1, 1, 2, 2, 2, -1, 1, 1}, 5126, "VEC3");
    const int r = glb.add(std::vector<std::int8_t>{0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127}, 5120, "VEC4");
    glb.json["accessors"][static_cast<std::size_t>(r)]["normalized"] = true;
    glb.json["nodes"][0]["translation"] = {0, 0, 5};
    glb.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", t}, {"SCALE", s}, {"ROTATION", r}};
    const auto parts = glb.read();
    ASSERT_EQ(parts.size(), 3u);
    expect_box(parts[0], {0, 0, 5}, {1, 2, 8});
    expect_box(parts[1], {10, 0, 5}, {12, 4, 11});
    expect_box(parts[2], {-1, 10, 5}, {0, 12, 8});
  }
}

TEST(Gltf, QuantisedPositionsAreRead) {
  Glb glb;
  glb.require("KHR_mesh_quantization");
  std::vector<std::uint16_t> whole;
  std::vector<std::int16_t> shares;
  const Mesh box = testing::box({0, 0, 0}, {1, 2, 3});
  for (const auto& v : box.vertices)
    for (int k = 0; k < 3; ++k) {
      whole.push_back(static_cast<std::uint16_t>(1000 * v[k]));
      shares.push_back(static_cast<std::int16_t>(std::lround(32767 * v[k] / 4)));
    }
  const int integers = glb.add(whole, 5123, "VEC3"), normalized = glb.add(shares, 5122, "VEC3");
  glb.json["accessors"][static_cast<std::size_t>(normalized)]["normalized"] = true;
  glb.json["nodes"][0]["scale"] = {0.001, 0.001, 0.001};
  glb.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = integers;
  ASSERT_EQ(glb.read().size(), 1u);
  expect_box(glb.read()[0], {0, 0, 0}, {1, 2, 3});
  glb.json["nodes"][0]["scale"] = {4, 4, 4};
  glb.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = normalized;
  EXPECT_LT((glb.read()[0].mesh.box().hi - Eigen::Vector3d(1, 2, 3)).norm(), 1e-3);
}

TEST(Gltf, JointsPlaceASkinnedMesh) {
  Glb glb;
  std::vector<std::uint8_t> joints;
  std::vector<float> weights;
  for (std::size_t i = 0; i < glb.vertices; ++i) {
    joints.insert(joints.end(), {0, 1, 0, 0});
    weights.insert(weights.end(), {0.5f, 0.5f, 0, 0});
  }
  auto& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = glb.add(joints, 5121, "VEC4");
  attributes["WEIGHTS_0"] = glb.add(weights, 5126, "VEC4");
  std::vector<float> inverse;
  for (int joint = 0; joint < 2; ++joint)
    inverse.insert(inverse.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1});
  const int matrices = glb.add(inverse, 5126, "MAT4");
  glb.json["nodes"] = {{{"name", "peg"}, {"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}},
                       {{"translation", {1, 0, 1}}, {"children", {2}}},
                       {{"translation", {2, 0, 0}}}};
  glb.json["scenes"][0]["nodes"] = {0, 1};
  glb.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", matrices}}};
  const auto parts = glb.read();
  ASSERT_EQ(parts.size(), 1u);
  expect_box(parts[0], {2, 0, 0}, {3, 2, 3});  // half way between x = 1 and x = 3
}

TEST(Gltf, MorphTargetsAreApplied) {
  Glb glb;
  std::vector<float> shift;
  for (std::size_t i = 0; i < glb.vertices; ++i) shift.insert(shift.end(), {0, 4, 0});
  glb.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", glb.add(shift, 5126, "VEC3")}}};
  expect_box(glb.read().at(0), {0, 0, 0}, {1, 2, 3});
  glb.json["meshes"][0]["weights"] = {0.5};
  expect_box(glb.read().at(0), {0, 2, 0}, {1, 4, 3});
  glb.json["nodes"][0]["weights"] = {0.25};
  expect_box(glb.read().at(0), {0, 1, 0}, {1, 3, 3});
}

TEST(Gltf, HiddenNodesAndOtherScenesAreNoted) {
  Glb glb;
  const Json hidden = {{"KHR_node_visibility", {{"visible", false}}}};
  glb.json["nodes"] = {{{"name", "shown"}, {"mesh", 0}},
                       {{"name", "ghost"}, {"extensions", hidden}, {"children", {2}}},
                       {{"name", "child"}, {"mesh", 0}},
                       {{"name", "elsewhere"}, {"mesh", 0}}};
  glb.json["scenes"][0]["nodes"] = {0, 1};
  const auto parts = glb.read();
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].problem, "");
  EXPECT_EQ(parts[1].name, "child");
  EXPECT_NE(parts[1].problem.find("hidden"), std::string::npos);
  EXPECT_EQ(parts[2].name, "elsewhere");
  EXPECT_TRUE(parts[1].by_meaning && parts[2].by_meaning);
}

TEST(Gltf, StripsFansAndSparsePositions) {
  Glb glb;
  const Mesh box = testing::box({0, 0, 0}, {1, 2, 3});
  // Sparse: the corner at (1, 2, 3) moves to x = 5.
  std::uint16_t far = 0;
  for (std::size_t i = 0; i < box.vertices.size(); ++i)
    if (box.vertices[i] == Eigen::Vector3d(1, 2, 3)) far = static_cast<std::uint16_t>(i);
  glb.add(std::vector<std::uint16_t>{far}, 5123, "SCALAR");
  glb.add(std::vector<float>{5, 2, 3}, 5126, "VEC3");
  glb.json["accessors"][0]["sparse"] = {
      {"count", 1}, {"indices", {{"bufferView", 2}, {"componentType", 5123}}}, {"values", {{"bufferView", 3}}}};
  EXPECT_NEAR(glb.read().at(0).mesh.box().hi.x(), 5, 1e-6);
  // A square as a strip and as a fan.
  for (const auto& [mode, corners] :
       std::vector<std::pair<int, std::vector<std::uint16_t>>>{{5, {0, 1, 2, 3}}, {6, {0, 1, 3, 2}}}) {
    Glb square;
    const int p = square.add(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, 5126, "VEC3");
    square.json["meshes"][0]["primitives"] = {
        {{"attributes", {{"POSITION", p}}}, {"indices", square.add(corners, 5123, "SCALAR")}, {"mode", mode}}};
    const auto part = square.read().at(0);
    ASSERT_EQ(part.mesh.triangles.size(), 2u);
    for (std::size_t t = 0; t < 2; ++t) {
      const Eigen::Vector3d a = part.mesh.vertex(t, 0);
      EXPECT_GT((part.mesh.vertex(t, 1) - a).cross(part.mesh.vertex(t, 2) - a).z(), 0) << mode;
    }
  }
}

TEST(Gltf, DamageIsRefused) {
  const auto with = [](const char* pointer, Json value) {
    Glb glb;
    glb.json[Json::json_pointer(pointer)] = std::move(value);
    return glb.error();
  };
  EXPECT_NE(with("/accessors/0/count", 4000), "");
  EXPECT_NE(with("/accessors/1/count", 999999999999), "");
  EXPECT_NE(with("/bufferViews/0/byteOffset", 100000), "");
  EXPECT_NE(with("/bufferViews/1/byteStride", 0), "");
  EXPECT_NE(with("/nodes/0/mesh", 7), "");
  EXPECT_NE(with("/nodes/0/children", {0}), "");
  EXPECT_NE(with("/scenes/0/nodes", {9}), "");
  EXPECT_NE(with("/nodes/0/matrix", {1, 2, 3}), "");
  EXPECT_NE(with("/asset/version", "3.0").find("version"), std::string::npos);
}

TEST(Gltf, NodesThatShowNothingAreNamed) {
  Glb glb;
  const int none = glb.add(std::vector<float>{}, 5126, "VEC3");
  const int ids = glb.add(std::vector<std::uint16_t>{7, 8}, 5123, "SCALAR");
  const auto instances = [](const char* name, int accessor) {
    return Json{{"EXT_mesh_gpu_instancing", {{"attributes", {{name, accessor}}}}}};
  };
  glb.json["nodes"] = {{{"mesh", 0}, {"name", "none"}, {"extensions", instances("TRANSLATION", none)}},
                       {{"mesh", 0}, {"name", "two"}, {"extensions", instances("_ID", ids)}},
                       {{"mesh", 0}, {"name", "hidden"}, {"scale", {0, 0, 0}}},
                       {{"mesh", 0}, {"name", "flat"}, {"scale", {1, 0, 1}}}};
  glb.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
  const auto parts = glb.read();
  ASSERT_EQ(parts.size(), 5u);
  EXPECT_EQ(parts[0].problem, "it has no instances");
  EXPECT_EQ(parts[1].problem + parts[2].problem, "");
  EXPECT_TRUE(parts[3].by_meaning) << parts[3].problem;
  EXPECT_NE(parts[4].problem, "");
  EXPECT_FALSE(parts[4].by_meaning);
  Glb cut;
  cut.json["accessors"][1]["count"] = 35;
  EXPECT_NE(cut.error().find("no whole triangles"), std::string::npos) << cut.error();
}

TEST(Gltf, ABufferBesideAGlbFileBelongsToIt) {
  const TempFolder folder;
  folder.write("b.bin", "data");
  std::string text = R"({"asset":{"version":"2.0"},"buffers":[{"uri":"b.bin","byteLength":4}]})";
  while (text.size() % 4 != 0) text += ' ';
  const auto word = [](std::size_t n) {
    const auto value = static_cast<std::uint32_t>(n);
    return std::string(reinterpret_cast<const char*>(&value), 4);
  };
  const auto file =
      folder.write("a.glb", "glTF" + word(2) + word(20 + text.size()) + word(text.size()) + "JSON" + text);
  ASSERT_EQ(MeshFiles().referenced_files(file).size(), 1u) << "the hash of the plan covers it";
}

}  // namespace
}  // namespace dismantle::mesh_files
