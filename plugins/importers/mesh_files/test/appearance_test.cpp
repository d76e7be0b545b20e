// Colours: one per part or none, for any file.
#include "appearance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dismantle/run_context.h"
#include "mesh_files.h"
#include "test/fixtures.h"

namespace dismantle::mesh_files {
namespace {

using testing::TempFolder;

TEST(Appearance, LinearLightIsEncodedAsSrgb) {
  // Known values of IEC 61966-2-1, and the law that decoding inverts encoding.
  EXPECT_EQ(rgba(0, 0.5, 1, 1, true), (Rgba{0, 188, 255, 255}));
  EXPECT_EQ(rgba(0, 0.5, 1, 0.5, false), (Rgba{0, 128, 255, 128}));
  Rng rng(4);
  for (int round = 0; round < 1000; ++round) {
    const double light = rng.uniform();
    const double s = rgba(light, 0, 0, 1, true)->r / 255.0;
    const double decoded = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(decoded, light, 0.005);
  }
  EXPECT_FALSE(rgba(std::numeric_limits<double>::quiet_NaN(), 0, 0, 1, false));
  EXPECT_EQ(rgba(-3, 7, 0, 9, false), (Rgba{0, 255, 0, 255}));
}

TEST(Appearance, OneColourOrNone) {
  Rng rng(6);
  const std::optional<Rgba> colours[] = {std::nullopt, Rgba{1, 2, 3}, Rgba{4, 5, 6}};
  for (int round = 0; round < 500; ++round) {
    OneColour one;
    std::vector<std::optional<Rgba>> added;
    for (auto n = 1 + rng.below(4); n > 0; --n) {
      added.push_back(colours[rng.below(3)]);
      one.add(added.back());
    }
    const bool same = std::all_of(added.begin(), added.end(), [&](const auto& c) { return c == added[0]; });
    EXPECT_EQ(one.get(), same ? added[0] : std::nullopt);
  }
}

TEST(Appearance, MaterialLibraries) {
  const TempFolder folder;
  const auto file = folder.write("a.mtl",
                                 "# comment\nKd 1 1 1\nnewmtl red paint\nKa 0 0 0\nKd 1 0 0\nd 0.5\n"
                                 "newmtl grey\nKd 0.2\nTr 1\nnewmtl none\nNs 3\nnewmtl odd\nKd nan 0 0\n");
  const auto colours = read_material_library(file);
  EXPECT_EQ(colours, (std::map<std::string, Rgba>{{"red paint", {255, 0, 0, 128}}, {"grey", {51, 51, 51, 0}}}));
  EXPECT_TRUE(read_material_library(folder / "gone.mtl").empty());
  EXPECT_TRUE(read_material_library(folder.write("binary.mtl", std::string("newmtl a\nKd 1 1\0 1", 20))).empty());
}

TEST(Appearance, AnObjPartOfTwoColoursHasNone) {
  const TempFolder folder;
  folder.write("p.mtl", "newmtl r\nKd 1 0 0\nnewmtl b\nKd 0 0 1\n");
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const auto colours = [&](const std::string& faces) {
    std::vector<std::optional<Rgba>> out;
    for (const RawPart& part : MeshFiles().read(folder.write("a.obj", "mtllib p.mtl\n" + points + faces), {}))
      out.push_back(part.colour);
    return out;
  };
  const std::optional<Rgba> red = Rgba{255, 0, 0}, blue = Rgba{0, 0, 255}, none;
  using Colours = std::vector<std::optional<Rgba>>;
  EXPECT_EQ(colours("o a\nusemtl r\nf 1 2 3\no b\nf 1 2 4\n"), (Colours{red, red}));
  EXPECT_EQ(colours("o a\nusemtl r\nf 1 2 3\nusemtl b\nf 1 2 4\n"), (Colours{none}));
  EXPECT_EQ(colours("o a\nf 1 2 3\nusemtl b\nf 1 2 4\n"), (Colours{none}));
  EXPECT_EQ(colours("g a\nusemtl b\nf 1 2 3\ng b\nusemtl unknown\nf 1 2 4\n"), (Colours{blue, none}));
  EXPECT_EQ(colours("o a\ng x\nusemtl b\nf 1 2 3\ng y\nf 1 2 4\no b\nf 2 3 4\n"), (Colours{blue, blue}));
}

}  // namespace
}  // namespace dismantle::mesh_files
