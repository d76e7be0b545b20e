// Round trips through every format, and known faults of assimp.
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Exporter.hpp>
#include <map>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/mesh_repair.h"
#include "mesh_files.h"
#include "test/fixtures.h"

namespace dismantle::mesh_files {
namespace {

using testing::expect_box;
using testing::TempFolder;

void fill(aiMesh& to, const Mesh& from) {
  to.mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  to.mNumVertices = static_cast<unsigned>(from.vertices.size());
  to.mVertices = new aiVector3D[to.mNumVertices];
  to.mNormals = new aiVector3D[to.mNumVertices];
  for (unsigned i = 0; i < to.mNumVertices; ++i) {
    const auto& v = from.vertices[i];
    to.mVertices[i] = aiVector3D(static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()));
    to.mNormals[i] = aiVector3D(0, 0, 1);
  }
  to.mNumFaces = static_cast<unsigned>(from.triangles.size());
  to.mFaces = new aiFace[to.mNumFaces];
  for (unsigned i = 0; i < to.mNumFaces; ++i) {
    to.mFaces[i].mNumIndices = 3;
    to.mFaces[i].mIndices = new unsigned[3];
    for (unsigned k = 0; k < 3; ++k) to.mFaces[i].mIndices[k] = from.triangles[i][k];
  }
}

/// One mesh (a box of volume 6) under a root, with a node for each transform.
void make_scene(aiScene& scene, const std::vector<std::pair<std::string, aiMatrix4x4>>& nodes) {
  scene.mNumMeshes = 1;
  scene.mMeshes = new aiMesh* [1] { new aiMesh };
  scene.mMeshes[0]->mName = "box";
  fill(*scene.mMeshes[0], testing::box({0, 0, 0}, {1, 2, 3}));
  scene.mNumMaterials = 1;
  scene.mMaterials = new aiMaterial* [1] { new aiMaterial };
  scene.mRootNode = new aiNode("root");
  scene.mRootNode->mNumChildren = static_cast<unsigned>(nodes.size());
  scene.mRootNode->mChildren = new aiNode*[nodes.size()];
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    auto* node = new aiNode(nodes[i].first);
    node->mTransformation = nodes[i].second;
    node->mParent = scene.mRootNode;
    node->mNumMeshes = 1;
    node->mMeshes = new unsigned[1]{0};
    scene.mRootNode->mChildren[i] = node;
  }
}

aiMatrix4x4 affine(float a, float b, float c, float x, float y, float z) {
  return {a, 0, 0, x, 0, b, 0, y, 0, 0, c, z, 0, 0, 0, 1};
}

class SceneFormat : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(SceneFormat, NodesArePartsWithTheirTransforms) {
  const auto [format, ending] = GetParam();
  const TempFolder folder;
  aiScene scene;
  make_scene(scene, {{"left", affine(1, 1, 1, 10, 0, 0)},
                     {"mirrored", affine(-1, 1, 1, 0, 20, 0)},
                     {"large", affine(2, 2, 2, 0, 0, 30)}});
  const auto file = folder / (std::string("a.") + ending);
  Assimp::Exporter exporter;
  ASSERT_EQ(exporter.Export(&scene, format, file.string()), aiReturn_SUCCESS) << exporter.GetErrorString();
  MeshFiles importer;
  const auto parts = importer.read(file, {});
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].name, "left");
  EXPECT_EQ(parts[1].name, "mirrored");
  EXPECT_EQ(parts[2].name, "large");
  EXPECT_EQ(parts[0].file, file.filename().string());
  expect_box(parts[0], {10, 0, 0}, {11, 2, 3});
  expect_box(parts[1], {-1, 20, 0}, {0, 22, 3});
  expect_box(parts[2], {0, 0, 30}, {2, 4, 36});
}

INSTANTIATE_TEST_SUITE_P(Assimp, SceneFormat,
                         ::testing::Values(std::pair{"glb2", "glb"}, std::pair{"gltf2", "gltf"},
                                           std::pair{"collada", "dae"}),
                         [](const auto& p) { return std::string(p.param.second); });

class MeshFormat : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(MeshFormat, ComesBackAsItWas) {
  const auto [format, ending] = GetParam();
  const TempFolder folder;
  aiScene scene;
  make_scene(scene, {{"only", aiMatrix4x4()}});
  const auto file = folder / (std::string("a.") + ending);
  Assimp::Exporter exporter;
  ASSERT_EQ(exporter.Export(&scene, format, file.string()), aiReturn_SUCCESS) << exporter.GetErrorString();
  MeshFiles importer;
  const auto parts = importer.read(file, {});
  ASSERT_EQ(parts.size(), 1u);
  expect_box(parts[0], {0, 0, 0}, {1, 2, 3});
}

INSTANTIATE_TEST_SUITE_P(Assimp, MeshFormat,
                         ::testing::Values(std::pair{"ply", "ply"}, std::pair{"plyb", "ply"}, std::pair{"stl", "stl"},
                                           std::pair{"stlb", "stl"}, std::pair{"obj", "obj"}, std::pair{"3mf", "3mf"}),
                         [](const auto& p) { return std::string(p.param.first) + "_as_" + p.param.second; });

std::string dae(const std::string& unit, const std::string& up) {
  std::string positions, indices;
  const Mesh m = testing::box({0, 0, 0}, {1, 2, 3});
  for (const auto& v : m.vertices)
    for (int k = 0; k < 3; ++k) positions += std::to_string(v[k]) + " ";
  for (const auto& t : m.triangles)
    for (const auto i : t) indices += std::to_string(i) + " ";
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter=")" +
         unit + R"("/><up_axis>)" + up + R"(</up_axis></asset>
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="pa" count="24">)" +
         positions + R"(</float_array><technique_common><accessor source="#pa" count="8" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>)" +
         indices + R"(</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">
<node id="n1" name="gear one"><translate>5 0 0</translate><instance_geometry url="#g"/></node>
<node id="n2" name="gear two"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST(Dae, KeepsUnitsAndAxesOfTheFile) {
  const TempFolder folder;
  MeshFiles importer;
  for (const std::string unit : {"1", "0.001", "0.0254"})
    for (const std::string up : {"X_UP", "Y_UP", "Z_UP"}) {
      const auto parts = importer.read(folder.write("a.dae", dae(unit, up)), {});
      ASSERT_EQ(parts.size(), 2u) << unit << up;
      EXPECT_EQ(parts[0].name, "gear one");
      EXPECT_EQ(parts[0].unit, unit == "1" ? "m" : unit == "0.001" ? "mm" : "inch") << up;
      EXPECT_EQ(parts[1].name, "gear two");
      expect_box(parts[0], {5, 0, 0}, {6, 2, 3});
      expect_box(parts[1], {0, 0, 0}, {1, 2, 3});
    }
}

std::string model_3mf(const std::string& unit) {
  std::string mesh = "<mesh><vertices>";
  const Mesh m = testing::box({0, 0, 0}, {1, 2, 3});
  for (const auto& v : m.vertices)
    mesh += "<vertex x=\"" + std::to_string(v.x()) + "\" y=\"" + std::to_string(v.y()) + "\" z=\"" +
            std::to_string(v.z()) + "\"/>";
  mesh += "</vertices><triangles>";
  for (const auto& t : m.triangles)
    mesh += "<triangle v1=\"" + std::to_string(t[0]) + "\" v2=\"" + std::to_string(t[1]) + "\" v3=\"" +
            std::to_string(t[2]) + "\"/>";
  mesh += "</triangles></mesh>";
  return R"(<?xml version="1.0" encoding="UTF-8"?><model unit=")" + unit +
         R"(" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>
<object id="1" type="model" name="plate">)" +
         mesh + R"(</object><object id="2" type="model" name="pin">)" + mesh + R"(</object>
<object id="3" type="model" name="pair"><components><component objectid="1" transform="1 0 0 0 1 0 0 0 1 0 0 50"/></components></object>
</resources><build><item objectid="1"/><item objectid="2" transform="1 0 0 0 1 0 0 0 1 10 20 30"/>
<item objectid="3" transform="-1 0 0 0 1 0 0 0 1 0 100 0"/></build></model>)";
}

TEST(Mf3, BuildItemsAndComponentsArePlaced) {
  const TempFolder folder;
  MeshFiles importer;
  const std::string types =
      R"(<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)";
  const std::string rels =
      R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="r0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)";
  for (const std::string unit : {"millimeter", "inch"}) {
    const auto parts = importer.read(folder.write("a.3mf", testing::zip({{"[Content_Types].xml", types},
                                                                         {"_rels/.rels", rels},
                                                                         {"3D/3dmodel.model", model_3mf(unit)}})),
                                     {});
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_EQ(parts[0].name, "plate");
    EXPECT_EQ(parts[1].name, "pin");
    expect_box(parts[0], {0, 0, 0}, {1, 2, 3});
    expect_box(parts[1], {10, 20, 30}, {11, 22, 33});
    expect_box(parts[2], {-1, 100, 50}, {0, 102, 53});
  }
}

TEST(Assimp, RefusalsNameTheFile) {
  const TempFolder folder;
  MeshFiles importer;
  for (const std::string ending : {"glb", "gltf", "3mf", "dae", "ply"}) {
    const auto file = folder.write("broken." + ending, "this is no mesh at all");
    EXPECT_NE(testing::input_error([&] { importer.read(file, {}); }).find("broken." + ending), std::string::npos);
  }
  const auto points = folder.write("points.ply",
                                   "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                                   "property float z\nend_header\n0 0 0\n1 0 0\n");
  EXPECT_NE(testing::input_error([&] { importer.read(points, {}); }), "");
  const auto nan = folder.write("nan.ply",
                                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_NE(testing::input_error([&] { importer.read(nan, {}); }).find("not finite"), std::string::npos);
}

}  // namespace
}  // namespace dismantle::mesh_files
