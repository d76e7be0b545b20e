// DAE files made here: what they use and lack, cycles, materials, primitives, encodings.
#include <gtest/gtest.h>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/mesh_repair.h"
#include "dismantle/run_context.h"
#include "mesh_files.h"
#include "test/fixtures.h"

namespace dismantle::mesh_files {
namespace {

using testing::input_error;
using testing::TempFolder;

/// Corners of the faces of a box, outward, by the bits of their index.
constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

std::string listed(int from, int to) {
  std::string out;
  for (int f = from; f < to; ++f)
    for (const int k : {0, 1, 2, 0, 2, 3}) out += std::to_string(kFaces[f][k]) + " ";
  return out;
}

std::string triangles(const std::string& id, int from, int to, const std::string& material) {
  return "<triangles count=\"" + std::to_string(2 * (to - from)) + "\" material=\"" + material +
         "\"><input semantic=\"VERTEX\" source=\"#v" + id + "\" offset=\"0\"/><p>" + listed(from, to) +
         "</p></triangles>";
}

/// A geometry whose positions are the corners of a box from `lo`, of volume 6, with the given primitives.
std::string geometry(const std::string& id, const Eigen::Vector3d& lo, const std::string& primitives) {
  std::string numbers;
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 3; ++k) numbers += std::to_string(lo[k] + ((i >> k & 1) ? k + 1 : 0)) + " ";
  return "<geometry id=\"" + id + "\"><mesh><source id=\"p" + id + "\"><float_array id=\"a" + id + "\" count=\"24\">" +
         numbers + "</float_array><technique_common><accessor source=\"#a" + id +
         "\" count=\"8\" stride=\"3\"/></technique_common></source><vertices id=\"v" + id +
         "\"><input semantic=\"POSITION\" source=\"#p" + id + "\"/></vertices>" + primitives + "</mesh></geometry>";
}

std::string box(const std::string& id, const Eigen::Vector3d& lo) {
  return geometry(id, lo, triangles(id, 0, 3, "one") + triangles(id, 3, 6, "two"));
}

std::string node(const std::string& name, const std::string& content) {
  return "<node id=\"" + name + "\" name=\"" + name + "\">" + content + "</node>";
}

std::string uses(const std::string& url, const std::string& kind = "geometry") {
  return "<instance_" + kind + " url=\"" + url + "\"/>";
}

std::string document(const std::string& geometries, const std::string& nodes, const std::string& libraries = "") {
  return "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\"><asset><unit meter=\"0.001\"/></asset>"
         "<library_geometries>" +
         geometries + "</library_geometries>" + libraries + "<library_visual_scenes><visual_scene id=\"s\">" + nodes +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

std::vector<RawPart> read(const TempFolder& folder, const std::string& text) {
  return MeshFiles().read(folder.write("a.dae", text), {});
}

std::string error_of(const TempFolder& folder, const std::string& text) {
  return input_error([&] { read(folder, text); });
}

double volume(const RawPart& part) {
  Mesh mesh = part.mesh;
  weld(mesh, 1e-9);
  return edge_use(mesh).closed() ? signed_volume(mesh) : -1;
}

TEST(Dae, WhatIsNotThereOrNotReadIsNamed) {
  const TempFolder folder;
  const std::string good = node("good", uses("#g"));
  struct Case {
    std::string geometries, nodes, libraries, said;
    bool by_meaning;
  };
  const std::string skin =
      "<library_controllers><controller id=\"k\"><skin source=\"#g\"/></controller></library_controllers>";
  const std::vector<Case> cases{
      {"", node("c", uses("#none")), "", "'#none', which the file lacks", false},
      {"", node("c", uses("other.dae#g")), "", "another file", false},
      {"", node("c", uses("#none", "node")), "", "'#none', which the file lacks", false},
      {"", node("c", uses("other.dae#n", "node")), "", "another file", false},
      {"", node("c", uses("#none", "controller")), "", "'#none', which the file lacks", false},
      {"", node("c", uses("#k", "controller")), skin, "deformed by a skin", false},
      {"<geometry id=\"x\"><convex_mesh/></geometry>", node("c", uses("#x")), "", "<convex_mesh>", false},
      {"<geometry id=\"x\"><brep/></geometry>", node("c", uses("#x")), "", "<brep>", false},
      {"<geometry id=\"x\"><mesh/></geometry>", node("c", uses("#x")), "", "no triangles", false},
      {geometry("x", {0, 0, 0},
                "<polygons count=\"1\"><input semantic=\"VERTEX\" source=\"#vx\" offset=\"0\"/>"
                "<ph><p>0 1 3 2</p><h>4 5 7</h></ph></polygons>"),
       node("c", uses("#x")), "", "polygons with holes", false},
      {"", node("c", "<scale>1 0 1</scale>" + uses("#g")), "", "flattens", false},
      {"", node("c", "<scale>0 0 0</scale>" + uses("#g")), "", "scale of zero", true},
      {"<geometry id=\"x\"><spline/></geometry>", node("c", uses("#x")), "", "only points or lines", true},
      {geometry("x", {0, 0, 0}, "<lines count=\"1\"><p>0 1</p></lines>"), node("c", uses("#x")), "", "only points",
       true},
      {box("c", {9, 9, 9}), "", "", "no node uses it", true},
      {"",
       node("c", uses("#g") + "<extra><technique profile=\"FCOLLADA\"><visibility>0</visibility></technique></extra>"),
       "", "hidden", true}};
  for (const Case& c : cases) {
    const auto parts = read(folder, document(box("g", {0, 0, 0}) + c.geometries, good + c.nodes, c.libraries));
    ASSERT_EQ(parts.size(), 2u) << c.said;
    EXPECT_NEAR(volume(parts[0]), 6, 1e-9);
    EXPECT_EQ(parts[1].name.substr(0, 1), c.said.starts_with("x") ? "x" : "c") << c.said;
    EXPECT_NE(parts[1].problem.find(c.said), std::string::npos) << c.said << " | " << parts[1].problem;
    EXPECT_EQ(parts[1].by_meaning, c.by_meaning) << c.said;
  }
}

TEST(Dae, OneOfTwoGeometriesOfANodeIsMissing) {
  const TempFolder folder;
  const auto parts = read(folder, document(box("g", {0, 0, 0}), node("c", uses("#g") + uses("#none"))));
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NE(parts[0].problem.find("'#none'"), std::string::npos);
  EXPECT_NEAR(volume(parts[1]), 6, 1e-9);
}

TEST(Dae, NodesOfOtherScenesAreNoted) {
  const TempFolder folder;
  const auto parts = read(folder, document(box("g", {0, 0, 0}), node("good", uses("#g")),
                                           "<library_visual_scenes><visual_scene id=\"t\">" + node("c", uses("#g")) +
                                               "</visual_scene></library_visual_scenes>"));
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NE(parts[1].problem.find("in no scene"), std::string::npos);
  EXPECT_TRUE(parts[1].by_meaning);
}

TEST(Dae, NodesOfLibrariesArePlacedWhereTheyAreUsed) {
  const TempFolder folder;
  const std::string library =
      "<library_nodes>" + node("lib", "<translate>0 0 7</translate>" + uses("#g")) + "</library_nodes>";
  const auto parts =
      read(folder, document(box("g", {0, 0, 0}),
                            node("a", "<matrix>-1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1</matrix>" + uses("#lib", "node")) +
                                node("b", "<rotate>0 0 1 90</rotate>" + uses("#lib", "node")),
                            library));
  ASSERT_EQ(parts.size(), 2u);
  for (const RawPart& part : parts) EXPECT_NEAR(volume(part), 6, 1e-9);
  EXPECT_LT((parts[0].mesh.box().lo - Eigen::Vector3d(4, 0, 7)).norm(), 1e-12);
  EXPECT_LT((parts[1].mesh.box().lo - Eigen::Vector3d(-2, 0, 7)).norm(), 1e-12);
}

TEST(Dae, NodesThatUseThemselvesOrMultiplyAreRefused) {
  const TempFolder folder;
  const std::string g = box("g", {0, 0, 0});
  EXPECT_NE(error_of(folder, document(g, node("c", uses("#c", "node")))).find("'c' contains itself"),
            std::string::npos);
  EXPECT_NE(error_of(folder, document(g, node("c", uses("#m", "node")),
                                      "<library_nodes>" + node("m", uses("#n", "node")) +
                                          node("n", uses("#m", "node")) + "</library_nodes>"))
                .find("contains itself"),
            std::string::npos);
  std::string bomb, chain;
  for (int i = 0; i < 30; ++i) {
    std::string tenfold;
    for (int k = 0; k < 10; ++k) tenfold += uses("#n" + std::to_string(i + 1), "node");
    bomb += node("n" + std::to_string(i), tenfold);
  }
  for (int i = 0; i < 5000; ++i) chain += node("n" + std::to_string(i), uses("#n" + std::to_string(i + 1), "node"));
  const auto library = [](const std::string& nodes, int last) {
    return "<library_nodes>" + nodes + node("n" + std::to_string(last), uses("#g")) + "</library_nodes>";
  };
  EXPECT_NE(error_of(folder, document(g, node("c", uses("#n0", "node")), library(bomb, 30))).find("more than 1000000"),
            std::string::npos);
  EXPECT_NE(error_of(folder, document(g, node("c", uses("#n0", "node")), library(chain, 5000))).find("200 deep"),
            std::string::npos);
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<node>";
  EXPECT_NE(error_of(folder, document(g, deep)).find("1000 deep"), std::string::npos);
  EXPECT_NE(error_of(folder, document(g + box("g", {1, 1, 1}), node("c", uses("#g")))).find("several <geometry>"),
            std::string::npos);
}

/// assimp gave the second use of a geometry the triangles of another material where one of two materials was bound
/// anew.
TEST(Dae, MaterialsDoNotChangeShapes) {
  const TempFolder folder;
  std::string libraries = "<library_effects>";
  for (const std::string i : {"1", "2", "3"})
    libraries += "<effect id=\"e" + i + "\"><profile_COMMON><technique><phong><diffuse><color>" +
                 (i == "1" ? "1" : "0") + " 0 0 1</color></diffuse></phong></technique></profile_COMMON></effect>";
  libraries += "</library_effects><library_materials>";
  for (const std::string i : {"1", "2", "3"})
    libraries += "<material id=\"m" + i + "\"><instance_effect url=\"#e" + i + "\"/></material>";
  libraries += "</library_materials>";
  const auto use = [](const std::string& one, const std::string& two) {
    return "<instance_geometry url=\"#g\"><bind_material><technique_common><instance_material symbol=\"one\" "
           "target=\"#" +
           one + "\"/><instance_material symbol=\"two\" target=\"#" + two +
           "\"/></technique_common></bind_material></instance_geometry>";
  };
  const auto parts = read(folder, document(box("g", {0, 0, 0}),
                                           node("a", use("m1", "m1")) + node("b", use("m1", "m2")) +
                                               node("c", use("m1", "m3")) + node("d", use("m2", "m1")),
                                           libraries));
  ASSERT_EQ(parts.size(), 4u);
  for (const RawPart& part : parts) EXPECT_NEAR(volume(part), 6, 1e-9) << part.name;
  ASSERT_TRUE(parts[0].colour);
  EXPECT_EQ(parts[0].colour->r, 255);
  EXPECT_FALSE(parts[1].colour);
}

TEST(Dae, AllKindsOfFaces) {
  const TempFolder folder;
  const auto with = [](const std::string& kind, int count, const std::string& content) {
    return "<" + kind + " count=\"" + std::to_string(count) +
           "\"><input semantic=\"VERTEX\" source=\"#vg\" offset=\"0\"/><input semantic=\"NORMAL\" source=\"#n\" "
           "offset=\"1\"/>" +
           content + "</" + kind + ">";
  };
  std::string quads, polygons, fans, strips;
  for (const auto& face : kFaces) {
    std::string corners, strip;
    for (const int k : {0, 1, 2, 3}) corners += std::to_string(face[k]) + " 0\n";
    for (const int k : {0, 1, 3, 2}) strip += std::to_string(face[k]) + " 0\t";
    quads += corners;
    polygons += "<p>" + corners + "</p>";
    strips += "<p>" + strip + "</p>";
  }
  for (const std::string& primitives :
       {with("polylist", 6, "<vcount>4 4 4 4 4 4</vcount><p>" + quads + "</p>"), with("polygons", 6, polygons),
        with("trifans", 6, polygons), with("tristrips", 6, strips)}) {
    const auto parts = read(folder, document(geometry("g", {0, 0, 0}, primitives), node("c", uses("#g"))));
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_NEAR(volume(parts[0]), 6, 1e-9) << primitives.substr(0, 12);
  }
  for (const auto& [primitives, said] : std::vector<std::pair<std::string, std::string>>{
           {with("polylist", 6, "<vcount>4 4 4 4 4</vcount><p>" + quads + "</p>"), "states 6 faces"},
           {with("polylist", 6, "<vcount>4 4 4 4 4 5</vcount><p>" + quads + "</p>"), "states 6 faces"},
           {with("polygons", 7, polygons), "states 7 polygons"},
           {with("triangles", 12, "<p>0 0 1 0 2</p>"), "indices"},
           {with("triangles", 1, "<p>0 0 1 0 99 0</p>"), "'99' of 8"},
           {with("triangles", 1, "<p>0 0 1 0 x 0</p>"), "'x'"}})
    EXPECT_NE(error_of(folder, document(geometry("g", {0, 0, 0}, primitives), node("c", uses("#g")))).find(said),
              std::string::npos)
        << said;
}

TEST(Dae, NamesInOtherEncodings) {
  const TempFolder folder;
  const std::string content = document(box("g", {0, 0, 0}), node("Caf\xe9", uses("#g")));
  const auto parts = read(folder, "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>" + content);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].name, "Caf\xc3\xa9");
  EXPECT_NE(error_of(folder, "<?xml version=\"1.0\"?>" + content), "");
  EXPECT_NE(error_of(folder, "<!DOCTYPE a [<!ENTITY b \"c\">]>" + document(box("g", {0, 0, 0}), node("a", uses("#g"))))
                .find("document type"),
            std::string::npos);
}

}  // namespace
}  // namespace dismantle::mesh_files
