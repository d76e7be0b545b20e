#include <gtest/gtest.h>

#include "dismantle/errors.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/run_context.h"
#include "readers.h"
#include "test/fixtures.h"

namespace dismantle::mesh_files {
namespace {

using testing::input_error;
using testing::TempFolder;

std::string error_of(const std::string& text) {
  const TempFolder folder;
  const auto file = folder.write("bad part.obj", text);
  return input_error([&] { read_obj(file); });
}

TEST(ObjReader, KeepsEveryBitOfACoordinate) {
  const TempFolder folder;
  Rng rng(5);
  for (int round = 0; round < 20; ++round) {
    Mesh m = testing::box({-1, -1, -1}, {1, 1, 1});
    for (auto& v : m.vertices)
      for (int k = 0; k < 3; ++k) v[k] = v[k] * rng.uniform(0.1, 1) + rng.uniform(-1e6, 1e6);
    const auto parts = read_obj(folder.write("a.obj", testing::obj_text(m)));
    ASSERT_EQ(parts.size(), 1u);
    ASSERT_EQ(parts[0].mesh.triangles.size(), m.triangles.size());
    for (std::size_t t = 0; t < m.triangles.size(); ++t)
      for (int c = 0; c < 3; ++c) EXPECT_EQ(parts[0].mesh.vertex(t, c), m.vertex(t, c));
  }
}

TEST(ObjReader, UnderstandsAllFormsOfAFace) {
  const TempFolder folder;
  const std::string head =
      "\xEF\xBB\xBF# comment\r\nmtllib x.mtl\r\nv +0 0 0 1.0\r\nv 1e0 0 0 0.5 0.5 0.5\r\nv 1 1 0 # here\r\nv 0 1 0\r\n"
      "vt 0 0\r\nvn 0 0 1\r\nusemtl m\r\ns off\r\n";
  for (const std::string face : {"f 1 2 3\r\nf 1 3 4\r\n", "f 1/1 2/1 3/1\r\nf 1//1 3//1 4//1\r\n",
                                 "f 1/1/1 2/1/1 3/1/1 4/1/1\r\n", "f -4 -3 -2 -1\r\n", "f 1 2 \\\r\n 3 4\r\n"}) {
    // A continued line ends in a backslash before the CR in this file: only LF files may do that.
    std::string text = head + face;
    if (face.find('\\') != std::string::npos) std::erase(text, '\r');
    const auto parts = read_obj(folder.write("a.obj", text));
    ASSERT_EQ(parts.size(), 1u) << face;
    EXPECT_EQ(parts[0].mesh.triangles.size(), 2u) << face;
    EXPECT_NEAR(surface_area(parts[0].mesh), 1.0, 1e-15) << face;
  }
}

TEST(ObjReader, CutsConcavePolygonsInsideTheirOutline) {
  const TempFolder folder;
  const auto parts = read_obj(folder.write("l.obj",
                                           "v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf 1 2 3 4 5 6\n"
                                           "v 0 0 1\nv 3 0 1\nv 3 1 1\nv 1 1 1\nv 1 3 1\nv 0 3 1\nf 9 10 11 12 7 8\n"));
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].mesh.triangles.size(), 8u);
  EXPECT_NEAR(surface_area(parts[0].mesh), 10.0, 1e-12);
}

TEST(ObjReader, ObjectsAndGroupsAreParts) {
  const TempFolder folder;
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const auto names = [&](const std::string& text) {
    std::vector<std::string> out;
    for (const auto& p : read_obj(folder.write("a.obj", v + text))) out.push_back(p.name);
    return out;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names("o Schräge Welle 1\nf 1 2 3\no nut\nf 1 2 4\n"), (Names{"Schräge Welle 1", "nut"}));
  EXPECT_EQ(names("g a\nf 1 2 3\ng b\nf 1 2 4\ng a\nf 2 3 4\n"), (Names{"a", "b"}));
  EXPECT_EQ(names("o nut\nf 1 2 3\no nut\nf 1 2 4\n"), (Names{"nut", "nut"}));
  EXPECT_EQ(names("o empty\no nut\ng x\nf 1 2 3\ng y\nf 1 2 4\no bolt\nf 1 3 4\n"), (Names{"nut", "bolt"}));
  EXPECT_EQ(names("o file\ng x\nf 1 2 3\ng y\nf 1 2 4\n"), (Names{"x", "y"}));
  EXPECT_EQ(names("f 1 2 3\n"), (Names{""}));
}

TEST(ObjReader, NamesTheLineOfEveryError) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_NE(error_of("v 0 0 nan\n").find("line 1: coordinate 'nan' is not finite"), std::string::npos);
  EXPECT_NE(error_of(v + "v 1 2\n").find("line 4: a vertex needs three coordinates"), std::string::npos);
  EXPECT_NE(error_of(v + "v 1 2 3,5\n").find("line 4: '3,5' is no number"), std::string::npos);
  EXPECT_NE(error_of(v + "v 1 2 1e999\n").find("not finite"), std::string::npos);
  EXPECT_NE(error_of(v + "f 1 2 4\n").find("line 4: vertex 4 does not exist"), std::string::npos);
  EXPECT_NE(error_of(v + "f 1 2 0\n").find("vertex 0 does not exist"), std::string::npos);
  EXPECT_NE(error_of(v + "f 1 2 -4\n").find("vertex -4 does not exist"), std::string::npos);
  EXPECT_NE(error_of(v + "f 1 2\n").find("line 4: a face needs three corners"), std::string::npos);
  EXPECT_NE(error_of(v + "f a b c\n").find("'a' is no vertex number"), std::string::npos);
  EXPECT_NE(error_of(std::string("v 0 0 0\nv \0", 11)).find("line 2: binary data"), std::string::npos);
  EXPECT_NE(error_of("").find("no vertices"), std::string::npos);
  EXPECT_NE(error_of(v).find("3 vertices but no faces"), std::string::npos);
  EXPECT_NE(error_of(v + "f 1 2 9\n").find("bad part.obj"), std::string::npos);
  EXPECT_NE(error_of(v + "call more.obj\nf 1 2 3\n").find("in another file"), std::string::npos);
}

TEST(ObjReader, ObjectsThatAreNotReadAreNamed) {
  const TempFolder folder;
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n", surface = "surf 0 1 0 1 1 2 3 4\n";
  const auto file =
      folder.write("a.obj", corners + "o a\nfo 1 2 3\no wire\nl 1 2\no patch\n" + surface + "o b\nf 1 2 3\n" + surface);
  std::string log;
  RunContext context;
  context.on_log = [&](LogLevel, std::string_view text) { log += text; };
  const auto parts = read_obj(file, context);
  ASSERT_EQ(parts.size(), 4u);
  EXPECT_EQ(parts[0].mesh.triangles.size(), 1u);
  EXPECT_EQ(parts[2].name, "wire");
  EXPECT_TRUE(parts[2].by_meaning);
  EXPECT_EQ(parts[3].name, "patch");
  EXPECT_NE(parts[3].problem.find("free-form"), std::string::npos);
  EXPECT_FALSE(parts[3].by_meaning);
  EXPECT_NE(log.find("'b' has free-form surfaces"), std::string::npos) << log;
  log.clear();
  read_obj(folder.write("unnamed.obj", corners + "f 1 2 3\n" + surface), context);
  EXPECT_NE(log.find("'unnamed' has free-form surfaces"), std::string::npos) << log;
}

TEST(ObjReader, RandomDamageGivesAMeshOrAnInputError) {
  const TempFolder folder;
  const std::string good =
      "o a b\n" + testing::obj_text(testing::box({0, 0, 0}, {1, 2, 3})) + "g c\nf -1/2/3 -2//1 -3 -4/1\n";
  Rng rng(99);
  std::size_t read = 0, refused = 0;
  for (int round = 0; round < 1500; ++round) {
    std::string text = good;
    const auto edits = 1 + rng.below(6);
    for (std::uint64_t e = 0; e < edits && !text.empty(); ++e) {
      const auto at = rng.below(text.size());
      switch (rng.below(4)) {
        case 0:
          text[at] = static_cast<char>(rng.below(256));
          break;
        case 1:
          text.erase(at, 1 + rng.below(20));
          break;
        case 2:
          text.insert(at, 1, "0123456789-+./\\ \n\r#vfgoe"[rng.below(24)]);
          break;
        default:
          text.insert(at, text.substr(rng.below(text.size()), rng.below(30)));
          break;
      }
    }
    const auto file = folder.write("fuzz.obj", text);
    try {
      for (const auto& part : read_obj(file)) {
        ++read;
        for (const auto& v : part.mesh.vertices) ASSERT_TRUE(v.allFinite());
        for (const auto& t : part.mesh.triangles)
          for (const auto i : t) ASSERT_LT(i, part.mesh.vertices.size());
      }
    } catch (const InputError& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("fuzz.obj"), std::string::npos);
    }
  }
  EXPECT_GT(read, 100u);
  EXPECT_GT(refused, 100u);
}

TEST(ObjReader, CountsTriangles) {
  const TempFolder folder;
  EXPECT_EQ(count_obj_triangles(folder.write("a.obj", "v 0 0 0\nf 1 2 3\nf 1 2 3 4\n# f 1 2 3\nfoo 1 2 3\n")), 3u);
  EXPECT_FALSE(count_obj_triangles(folder / "missing.obj").has_value());
}

}  // namespace
}  // namespace dismantle::mesh_files
