#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/run_context.h"
#include "mesh_files.h"
#include "readers.h"
#include "test/fixtures.h"

namespace dismantle::mesh_files {
namespace {

using testing::input_error;
using testing::TempFolder;

const Mesh kBox = testing::box({0.5, -1, 2}, {1.5, 1, 5});  // volume 6; exact in single precision

TEST(StlReader, ReadsTextAndBinary) {
  const TempFolder folder;
  const auto binary = read_stl(folder.write("b.stl", testing::binary_stl(kBox)));
  ASSERT_EQ(binary.size(), 1u);
  EXPECT_EQ(binary[0].mesh.triangles.size(), 12u);
  EXPECT_DOUBLE_EQ(signed_volume(binary[0].mesh), 6);
  const auto text = read_stl(folder.write("t.stl", testing::text_stl(kBox, "a b") + testing::text_stl(kBox, "c")));
  ASSERT_EQ(text.size(), 2u);
  EXPECT_EQ(text[0].name, "a b");
  EXPECT_DOUBLE_EQ(signed_volume(text[1].mesh), 6);
}

TEST(StlReader, TextIsReadHoweverItIsSpelled) {
  const TempFolder folder;
  const std::string text = testing::text_stl(kBox, "a B");
  const auto replaced = [](std::string in, const std::string& from, const std::string& to) {
    for (std::size_t at = in.find(from); at != std::string::npos; at = in.find(from, at + to.size()))
      in.replace(at, from.size(), to);
    return in;
  };
  std::string upper = text;
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  for (const std::string& form :
       {upper, "\n\n  \r\n" + text, "\xEF\xBB\xBF\n" + text, replaced(text, "solid", "Solid"),
        replaced(replaced(text, "endloop", "end loop"), "endfacet", "end facet"), replaced(text, "\n", "\r"),
        replaced(text, "\n", "\r\n"), replaced(text, "facet normal", "\tFacet  Normal")}) {
    const auto file = folder.write("a.stl", form);
    std::vector<RawPart> parts;
    EXPECT_EQ(input_error([&] { parts = read_stl(file); }), "") << form.substr(0, 60);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_DOUBLE_EQ(signed_volume(parts[0].mesh), 6);
    EXPECT_EQ(count_stl_triangles(file), 12u);
  }
  const auto other = folder.write("other.stl", "This is a letter.\n" + std::string(200, 'x'));
  EXPECT_NE(input_error([&] { read_stl(other); }).find("text that does not begin with 'solid'"), std::string::npos);
}

TEST(StlReader, BinaryFilesMayStartWithSolid) {
  const TempFolder folder;
  std::string bytes = testing::binary_stl(kBox);
  bytes.replace(0, 6, "solid ");
  EXPECT_DOUBLE_EQ(signed_volume(read_stl(folder.write("b.stl", bytes)).at(0).mesh), 6);
}

TEST(StlReader, CutOffFilesAreRefusedAtEveryLength) {
  const TempFolder folder;
  for (const std::string& whole : {testing::binary_stl(kBox), testing::text_stl(kBox, "x")})
    for (std::size_t n = 0; n + 10 < whole.size(); n += 7) {
      const auto file = folder.write("cut.stl", whole.substr(0, n));
      EXPECT_NE(input_error([&] { read_stl(file); }).find("cut.stl"), std::string::npos) << n;
    }
}

TEST(StlReader, StatesWhatIsMissing) {
  const TempFolder folder;
  const std::string whole = testing::binary_stl(kBox);
  const auto file = folder.write("cut.stl", whole.substr(0, 300));
  EXPECT_NE(input_error([&] { read_stl(file); }).find("states 12 triangles, which take 684 bytes, but it has 300"),
            std::string::npos);
  EXPECT_EQ(count_stl_triangles(file), 12u);
}

TEST(StlReader, NamesTextInUtf16) {
  const TempFolder folder;
  for (const bool big : {false, true}) {
    std::string wide = big ? "\xFE\xFF" : "\xFF\xFE";
    for (const char c : testing::text_stl(kBox, "x")) (wide += big ? '\0' : c) += big ? c : '\0';
    const auto file = folder.write("wide.stl", wide);
    EXPECT_NE(input_error([&] { read_stl(file); }).find("text in UTF-16"), std::string::npos);
  }
}

TEST(StlReader, RefusesCoordinatesThatAreNotFinite) {
  const TempFolder folder;
  Mesh bad = kBox;
  bad.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  const auto binary = folder.write("b.stl", testing::binary_stl(bad));
  EXPECT_NE(input_error([&] { read_stl(binary); }).find("coordinate is not finite"), std::string::npos);
  const auto text = folder.write("t.stl", testing::text_stl(bad, "x"));
  EXPECT_NE(input_error([&] { read_stl(text); }).find("line "), std::string::npos);
}

/// A box as strips of one list, text or little-endian; `line_end` ends the lines of the header.
std::string ply_strips(const std::string& corners_type, bool binary, const std::string& line_end) {
  std::string out, data;
  for (const std::string& line :
       {std::string("ply"), std::string(binary ? "format binary_little_endian 1.0" : "format ascii 1.0"),
        std::string("element vertex 8"), std::string("property double x"), std::string("property double y"),
        std::string("property double z"), std::string("element tristrips 1"),
        "property list int " + corners_type + " vertex_indices", std::string("end_header")})
    out += line + line_end;
  const auto put = [&](auto value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (binary)
      data.append(bytes, sizeof value);
    else
      data += std::to_string(value) + " ";
  };
  for (int i = 0; i < 8; ++i) {
    // In a binary file the first byte of the data is a line feed.
    put(i % 2 ? 1.0 : binary ? std::bit_cast<double>(std::uint64_t{10}) : 0.0);
    put(i / 2 % 2 ? 2.0 : 0.0);
    put(i / 4 ? 3.0 : 0.0);
  }
  // Around the box then its two ends; triangles without area lead on.
  const std::vector<int> strips = {0, 1, 4, 5, 6, 7, 2, 3, 0, 1, -1, 0, 0, 0, 4, 2, 6, -1, 1, 3, 5, 7};
  put(static_cast<std::int32_t>(strips.size()));
  for (const int i : strips)
    if (corners_type == "uint")
      put(static_cast<std::uint32_t>(i));
    else
      put(static_cast<std::int32_t>(i));
  return out + data;
}

TEST(PlyReader, TriangleStripsAndLineEndsOfOldMacs) {
  const TempFolder folder;
  for (const bool binary : {false, true})
    for (const std::string type : {"int", "uint"})
      for (const std::string line_end : {"\n", "\r\n", "\r"}) {
        const auto parts = read_ply(folder.write("a.ply", ply_strips(type, binary, line_end)));
        ASSERT_EQ(parts.size(), 1u);
        EXPECT_EQ(parts[0].mesh.triangles.size(), 12u);
        EXPECT_DOUBLE_EQ(signed_volume(parts[0].mesh), 6) << binary << type << line_end.size();
      }
}

/// A box of quadrilaterals, or of triangles and quadrilaterals, whose list comes before that of the vertices.
TEST(PlyReader, FacesMayComeBeforeVertices) {
  const TempFolder folder;
  const std::string head = "ply\nformat ascii 1.0\n", end = "end_header\n",
                    vertex = "element vertex 8\nproperty float x\nproperty float y\nproperty float z\n",
                    corners = "0 0 0\n1 0 0\n0 2 0\n1 2 0\n0 0 3\n1 0 3\n0 2 3\n1 2 3\n",
                    list = "property list uchar int vertex_indices\n", first = "3 0 2 3\n3 0 3 1\n",
                    whole = "4 0 2 3 1\n", others = "4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
  for (const bool mixed : {false, true}) {
    const std::string face = (mixed ? "element face 7\n" : "element face 6\n") + list,
                      faces = (mixed ? first : whole) + others;
    for (const std::string& text :
         {head + vertex + face + end + corners + faces, head + face + vertex + end + faces + corners}) {
      const auto parts = read_ply(folder.write("a.ply", text));
      ASSERT_EQ(parts.size(), 1u);
      EXPECT_EQ(parts[0].mesh.triangles.size(), 12u);
      EXPECT_DOUBLE_EQ(signed_volume(parts[0].mesh), 6);
    }
  }
}

TEST(PlyReader, SaysWhyThereAreNoTriangles) {
  const TempFolder folder;
  const auto file = folder.write(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int corners\nend_header\n0 0 0\n3 0 0 0\n");
  EXPECT_NE(input_error([&] { read_ply(file); }).find("no list 'vertex_indices'"), std::string::npos);
}

TEST(OffReader, ReadsPolygonsAndKeepsDoubles) {
  const TempFolder folder;
  const auto parts = read_off(folder.write("a.off",
                                           "OFF # a box\n8 6 0\n0 0 0\n1.000000000000001 0 0\n1 1 0\n0 1 0\n0 0 1\n"
                                           "1 0 1\n1 1 1\n0 1 1\n4 3 2 1 0 255 0 0\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n"
                                           "4 1 2 6 5\n4 0 4 7 3\n"));
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].mesh.triangles.size(), 12u);
  EXPECT_EQ(parts[0].mesh.vertices[1].x(), 1.000000000000001);
  EXPECT_NEAR(signed_volume(parts[0].mesh), 1, 1e-14);
}

TEST(OffReader, RefusesDamage) {
  const TempFolder folder;
  const auto error = [&](const std::string& text) {
    const auto file = folder.write("a.off", text);
    return input_error([&] { read_off(file); });
  };
  EXPECT_NE(error("PFF\n").find("line 1"), std::string::npos);
  EXPECT_NE(error("OFF\n3 1 0\n0 0 0\n1 0 0\n").find("cut off after 2 of 3 vertices"), std::string::npos);
  EXPECT_NE(error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n").find("line 6: corner 3"), std::string::npos);
  EXPECT_NE(error("OFF\n1 0 0\n0 inf 0\n").find("line 3: coordinate 'inf'"), std::string::npos);
  EXPECT_NE(error("OFF\n3000000000 1 0\n").find("cut off after 0"), std::string::npos);
  EXPECT_NE(error("OFF\n1 0 0\n0 0 0\n").find("no faces"), std::string::npos);
}

TEST(StlReader, NoTriangleBehindTheStatedOnesIsLost) {
  const TempFolder folder;
  const std::string bytes = testing::binary_stl(kBox);
  std::string less = bytes;
  less[80] = 6;
  for (const std::string& form : {less, bytes + bytes}) {
    const std::string error = input_error([&] { read_stl(folder.write("a.stl", form)); });
    EXPECT_NE(error.find("there are more behind them"), std::string::npos) << error;
  }
  std::string solid = bytes + "some attributes of a program";
  solid.replace(0, 5, "solid");
  EXPECT_EQ(read_stl(folder.write("a.stl", solid)).at(0).mesh.triangles.size(), 12u);
  for (const std::size_t padding : {50, 200, 512})
    EXPECT_EQ(read_stl(folder.write("a.stl", bytes + std::string(padding, '\0'))).at(0).mesh.triangles.size(), 12u);
}

TEST(StlReader, ASolidWithoutTrianglesIsNamed) {
  const TempFolder folder;
  const auto parts = read_stl(folder.write("a.stl", testing::text_stl(kBox, "a") + "solid lost\nendsolid lost\n"));
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[1].name, "lost");
  EXPECT_EQ(parts[1].problem, "it has no triangles");
}

TEST(AllReaders, WhatFollowsTheStatedElementsIsNotLost) {
  const TempFolder folder;
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
      corners + "3 0 1 2\n";
  const std::string off = "OFF\n3 1 0\n" + corners + "3 0 1 2\n";
  EXPECT_EQ(read_ply(folder.write("a.ply", ply + "\n \n")).size(), 1u);
  EXPECT_EQ(read_off(folder.write("a.off", off + "\n# end\n")).size(), 1u);
  for (const auto& error : {input_error([&] { read_ply(folder.write("a.ply", ply + "3 0 2 1\n")); }),
                            input_error([&] { read_off(folder.write("a.off", off + "3 0 2 1\n")); })})
    EXPECT_NE(error.find("it goes on behind the"), std::string::npos) << error;
}

TEST(AllReaders, RandomDamageGivesAMeshOrAnInputError) {
  const TempFolder folder;
  MeshFiles importer;
  Rng rng(7);
  const std::string off = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 "
      "3 2\n";
  const std::vector<std::pair<std::string, std::string>> good = {
      {"off", off}, {"ply", ply}, {"stl", testing::text_stl(kBox, "x")}, {"stl", testing::binary_stl(kBox)}};
  for (int round = 0; round < 1200; ++round) {
    auto [ending, bytes] = good[rng.below(good.size())];
    for (std::uint64_t e = 1 + rng.below(4); e-- > 0;) {
      const auto at = rng.below(bytes.size());
      if (rng.below(3) == 0)
        bytes.erase(at, 1 + rng.below(5));
      else
        bytes[at] = static_cast<char>(rng.below(2) ? '0' + rng.below(10) : rng.below(256));
    }
    const auto file = folder.write("fuzz." + ending, bytes);
    input_error([&] {
      for (const auto& part : importer.read(file, {}))
        for (const auto& t : part.mesh.triangles)
          for (const auto i : t) ASSERT_LT(i, part.mesh.vertices.size());
    });
  }
}

}  // namespace
}  // namespace dismantle::mesh_files
