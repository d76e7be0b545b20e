#include <gtest/gtest.h>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/run_context.h"
#include "mesh_files.h"
#include "readers.h"
#include "tests/fixtures.h"

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

TEST(StlReader, RefusesCoordinatesThatAreNotFinite) {
  const TempFolder folder;
  Mesh bad = kBox;
  bad.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  const auto binary = folder.write("b.stl", testing::binary_stl(bad));
  EXPECT_NE(input_error([&] { read_stl(binary); }).find("coordinate is not finite"), std::string::npos);
  const auto text = folder.write("t.stl", testing::text_stl(bad, "x"));
  EXPECT_NE(input_error([&] { read_stl(text); }).find("line "), std::string::npos);
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
