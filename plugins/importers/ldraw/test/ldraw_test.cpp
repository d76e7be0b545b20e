// LDraw: what a model declares arrives, in its place, with its handedness and its order.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "dismantle/errors.h"
#include "dismantle/geometry/mesh_measure.h"
#include "ldraw_importer.h"

namespace dismantle::ldraw {
namespace {

namespace fs = std::filesystem;

/// A closed box from the origin to (x, y, z), LDraw units, wound counter-clockwise.
std::string box(double x, double y, double z) {
  const auto p = [&](int i) {
    return std::to_string(i & 1 ? x : 0) + " " + std::to_string(i & 2 ? y : 0) + " " + std::to_string(i & 4 ? z : 0);
  };
  std::string out;
  const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) out += "4 16 " + p(f[0]) + " " + p(f[1]) + " " + p(f[2]) + " " + p(f[3]) + "\n";
  return out;
}

class Ldraw : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("dismantle-ldraw-" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "library/parts/s");
    fs::create_directories(folder_ / "library/p");
    write("library/parts/brick.dat", "0 Brick  1 x  1\n0 !LDRAW_ORG Part\n0 BFC CERTIFY CCW\n" + box(20, 24, 10));
    write("library/parts/two.dat",
          "0 Two Bricks\n0 !LDRAW_ORG Shortcut\n0 BFC CERTIFY CCW\n"
          "1 16 0 0 0 1 0 0 0 1 0 0 0 1 brick.dat\n1 4 40 0 0 1 0 0 0 1 0 0 0 1 BRICK.DAT\n");
    write("library/LDConfig.ldr", "0 !COLOUR Red CODE 4 VALUE #C91A09 EDGE #333333\n");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  std::vector<RawPart> read(const std::string& text) {
    write("model.mpd", text);
    return LdrawImporter().read(folder_ / "model.mpd", {});
  }
  std::vector<ReferenceStep> order(const std::string& text) {
    write("model.mpd", text);
    return LdrawImporter().reference_order(folder_ / "model.mpd", {});
  }

  fs::path folder_;
};

TEST_F(Ldraw, PartsHaveTheirPlaceSizeAndColour) {
  const auto parts =
      read("0 Tower\n1 4 100 -24 0 1 0 0 0 1 0 0 0 1 brick.dat\n1 0x2112233 0 0 0 1 0 0 0 1 0 0 0 1 two.dat\n");
  ASSERT_EQ(parts.size(), 2u) << "a shortcut of two parts is one";
  EXPECT_EQ(parts[0].name, "Brick 1 x 1");
  EXPECT_EQ(parts[0].unit, "mm");
  EXPECT_EQ(parts[0].colour, (Rgba{0xC9, 0x1A, 0x09, 255}));
  EXPECT_EQ(parts[1].colour, (Rgba{0x11, 0x22, 0x33, 255}));
  const Aabb b = parts[0].mesh.box();  // -Y is up, here Z
  EXPECT_LT((b.lo - Eigen::Vector3d(40, 0, 0)).norm(), 1e-9);
  EXPECT_LT((b.hi - Eigen::Vector3d(48, 4, 9.6)).norm(), 1e-9);
  EXPECT_NEAR(signed_volume(parts[0].mesh), 8 * 4 * 9.6, 1e-9);
  EXPECT_NEAR(signed_volume(parts[1].mesh), 2 * 8 * 4 * 9.6, 1e-9);
}

TEST_F(Ldraw, WhatTheFileHidesIsNoted) {
  const auto line = [](int x) { return "1 4 " + std::to_string(x) + " 0 0 1 0 0 0 1 0 0 0 1 brick.dat\n"; };
  const auto parts = read("0 Tower\n" + line(0) + "0 STEP\n0 MLCAD HIDE " + line(100) + "0 GHOST " + line(200) +
                          "0 BUFEXCHG A STORE\n" + line(300) + "0 STEP\n0 BUFEXCHG A RETRIEVE\n" + line(400) +
                          "0 BUFEXCHG B RETRIEVE\n0 MLCAD BTG a group\n");
  ASSERT_EQ(parts.size(), 5u);
  int here = 0;
  for (const RawPart& part : parts) {
    EXPECT_EQ(part.name, "Brick 1 x 1");
    EXPECT_EQ(part.by_meaning, !part.problem.empty()) << part.problem;
    here += part.problem.empty();
  }
  EXPECT_EQ(here, 2);
  EXPECT_NE(parts[2].problem.find("MLCAD HIDE"), std::string::npos);
  EXPECT_NE(parts[4].problem.find("BUFEXCHG"), std::string::npos);
  EXPECT_LT((parts[1].mesh.box().lo - Eigen::Vector3d(160, 0, -9.6)).norm(), 1e-9);
  const auto steps = order("0 Tower\n" + line(0) + "0 STEP\n0 BUFEXCHG A STORE\n" + line(300) +
                           "0 STEP\n0 BUFEXCHG A RETRIEVE\n" + line(400) + "0 STEP\n");
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[1].parts, (std::vector<std::uint32_t>{1}));
}

/// Surfaces for programs that draw textures and those for others stand for each other: one of both is read.
TEST_F(Ldraw, SurfacesWithTexturesAreReadOnce) {
  const std::string all = box(20, 24, 10), start = "0 !TEXMAP START PLANAR 0 0 0 1 0 0 0 1 0 a.png\n";
  const auto first = all.find('\n') + 1;
  const std::string one = all.substr(0, first), rest = all.substr(first);
  for (const std::string& text :
       {start + "0 !: " + one + "0 !TEXMAP FALLBACK\n" + one + "0 !TEXMAP END\n" + rest,
        start + "0 !: " + one + "0 !TEXMAP END\n" + rest,
        start + "0 !: " + one + "0 !TEXMAP FALLBACK\n0 !TEXMAP END\n" + rest, start + one + "0 !TEXMAP END\n" + rest,
        rest + start + "0 !: " + one, "0 !TEXMAP NEXT PLANAR 0 0 0 1 0 0 0 1 0 a.png\n0 !: " + one + rest,
        "0 !TEXMAP NEXT PLANAR 0 0 0 1 0 0 0 1 0 a.png\n" + all, all + "0 !DATA a.png\n0 !: iVBORw0KGgo=\n"}) {
    write("library/parts/tile.dat", "0 Tile\n0 !LDRAW_ORG Part\n0 BFC CERTIFY CCW\n" + text);
    const auto parts = read("0 Tower\n1 4 0 0 0 1 0 0 0 1 0 0 0 1 tile.dat\n1 4 0 50 0 1 0 0 0 1 0 0 0 1 brick.dat\n");
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].mesh.triangles.size(), 12u) << text;
    EXPECT_NEAR(signed_volume(parts[0].mesh), 8 * 4 * 9.6, 1e-9) << text;
  }
}

/// Parts in colours whose finish is RUBBER bend; the word may be part of a colour's name.
TEST_F(Ldraw, PartsInColoursOfRubberAreFlexible) {
  write("library/LDConfig.ldr",
        "0 !COLOUR Red CODE 4 VALUE #C91A09 EDGE #333333\n"
        "0 !COLOUR Gummi CODE 900 VALUE #212121 EDGE #595959 RUBBER\n"
        "0 !COLOUR Gummi_Clear CODE 901 VALUE #FCFCFC EDGE #C9C9C9 ALPHA 128 RUBBER\n"
        "0 !COLOUR RUBBER CODE 902 VALUE #212121 EDGE #595959 CHROME\n");
  const auto line = [](const std::string& colour, int x, const std::string& file) {
    return "1 " + colour + " " + std::to_string(x) + " 0 0 1 0 0 0 1 0 0 0 1 " + file + "\n";
  };
  const auto parts = read("0 FILE tower.ldr\n0 Tower\n" + line("4", 0, "brick.dat") + line("900", 100, "two.dat") +
                          line("901", 200, "brick.dat") + line("902", 300, "brick.dat") +
                          line("0x2212121", 400, "brick.dat") + line("900", 500, "wheel.ldr") +
                          "0 FILE wheel.ldr\n0 Wheel\n" + line("16", 0, "brick.dat") + line("4", 50, "two.dat"));
  ASSERT_EQ(parts.size(), 7u);
  std::vector<bool> flexible;
  for (const RawPart& part : parts) flexible.push_back(part.flexible);
  EXPECT_EQ(flexible, (std::vector<bool>{false, true, true, false, false, true, false}));
  EXPECT_EQ(parts[1].colour, (Rgba{0x21, 0x21, 0x21, 255}));
}

/// The category is a statement, or the first word of the description.
TEST_F(Ldraw, TyresAreFlexibleInAnyColour) {
  const std::string at = "1 4 0 0 0 1 0 0 0 1 0 0 0 1 ";
  const std::string part = "0 !LDRAW_ORG Part\n0 BFC CERTIFY CCW\n" + box(20, 24, 10);
  write("library/parts/t1.dat", "0 Tyre  8/ 40 x  8\n" + part);
  write("library/parts/t2.dat", "0 ~Tyre 12/ 40 (Obsolete)\n" + part);
  write("library/parts/t3.dat", "0 Balloon\n0 !CATEGORY Tyre\n" + part);
  write("library/parts/t4.dat", "0 ~Moved to t1\n0 !LDRAW_ORG Part\n1 16 0 0 0 1 0 0 0 1 0 0 0 1 t1.dat\n");
  write("library/parts/w1.dat", "0 Wheel for Tyre\n" + part);
  write("library/parts/w2.dat", "0 Tyre Lever\n0 !CATEGORY Tool\n" + part);
  std::string model = "0 Car\n";
  for (const char* file : {"t1", "t2", "t3", "t4", "w1", "w2"}) model += at + file + ".dat\n";
  std::vector<bool> flexible;
  for (const RawPart& p : read(model)) flexible.push_back(p.flexible);
  EXPECT_EQ(flexible, (std::vector<bool>{true, true, true, true, false, false}));
}

/// The library keeps old numbers as files that only refer to the new one: the part has the name of that.
/// Three segments in a row, and what programs write around them.
TEST_F(Ldraw, SegmentsOfAPartThatBendsAreOneFlexiblePart) {
  const auto segments = [](const std::string& file) {
    std::string out;
    for (const int x : {0, 18, 36}) out += "1 4 " + std::to_string(x) + " 0 0 1 0 0 0 1 0 0 0 1 " + file + "\n";
    return out;
  };
  const std::string block = "0 SYNTH BEGIN HOSE_FLEXIBLE 4\n0 SYNTH SHOW\n0 SYNTH SYNTHESIZED BEGIN\n" +
                            segments("brick.dat") + "0 STEP\n0 SYNTH SYNTHESIZED END\n0 SYNTH END\n";
  const std::string before = "0 Pump\n1 4 0 50 0 1 0 0 0 1 0 0 0 1 brick.dat\n0 STEP\n";
  const std::string behind = "0 STEP\n1 4 0 100 0 1 0 0 0 1 0 0 0 1 brick.dat\n";
  const auto parts = read(before + block + behind);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[1].name, "HOSE FLEXIBLE");
  EXPECT_TRUE(parts[1].flexible);
  EXPECT_FALSE(parts[0].flexible || parts[2].flexible);
  EXPECT_EQ(parts[1].colour, (Rgba{0xC9, 0x1A, 0x09, 255}));
  EXPECT_NEAR(signed_volume(parts[1].mesh), 3 * 8 * 4 * 9.6, 1e-9);
  EXPECT_NEAR(parts[1].mesh.box().hi.x(), (36 + 20) * 0.4, 1e-9);
  const auto steps = order(before + block + behind);
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[1].parts, std::vector<std::uint32_t>{1});

  const std::string cable =
      "0 FILE cable.ldr\n0 A cable\n0 !LDCAD CONTENT [type=path]\n"
      "0 !LDCAD GENERATED [generator=LDCad 1.6d]\n" +
      segments("brick.dat");
  const auto bent = read("0 FILE a.ldr\n0 Pump\n1 16 0 0 0 -1 0 0 0 1 0 0 0 1 cable.ldr\n" + cable);
  ASSERT_EQ(bent.size(), 1u);
  EXPECT_EQ(bent[0].name, "A cable");
  EXPECT_TRUE(bent[0].flexible);
  EXPECT_NEAR(signed_volume(bent[0].mesh), 3 * 8 * 4 * 9.6, 1e-9) << "mirrored, and its outside stays outside";

  write("library/parts/link.dat", "0 Technic Chain Link\n0 !LDRAW_ORG Part\n0 BFC CERTIFY CCW\n" + box(20, 24, 10));
  EXPECT_EQ(read("0 Loader\n0 SYNTH BEGIN CHAIN 0\n0 SYNTH SYNTHESIZED BEGIN\n" + segments("link.dat")).size(), 3u)
      << "links are parts";
  const auto lost = read("0 Pump\n0 SYNTH BEGIN HOSE 0\n0 SYNTH SYNTHESIZED BEGIN\n" + segments("brick.dat") +
                         "1 4 54 0 0 1 0 0 0 1 0 0 0 1 nowhere.dat\n");
  ASSERT_EQ(lost.size(), 4u) << "a segment that is missing is named";
  EXPECT_FALSE(lost[3].problem.empty());
}

TEST_F(Ldraw, PartsThatHaveMovedHaveTheirName) {
  const std::string at = "1 16 0 0 0 1 0 0 0 1 0 0 0 1 ";
  write("library/parts/old.dat", "0 ~Moved to brick\n0 !LDRAW_ORG Part\n" + at + "brick.dat\n");
  write("library/parts/older.dat", "0 ~Moved to old\n0 !LDRAW_ORG Part\n" + at + "old.dat\n");
  write("library/parts/ring.dat", "0 ~Moved to round\n0 !LDRAW_ORG Part\n0 BFC CERTIFY CCW\n" + box(20, 24, 10));
  const auto parts = read("0 Tower\n" + at + "old.dat\n1 16 100 0 0 1 0 0 0 1 0 0 0 1 older.dat\n" +
                          "1 16 200 0 0 1 0 0 0 1 0 0 0 1 ring.dat\n");
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].name, "Brick 1 x 1");
  EXPECT_EQ(parts[1].name, "Brick 1 x 1");
  EXPECT_EQ(parts[2].name, "~Moved to round") << "it refers to nothing";
  EXPECT_NEAR(signed_volume(parts[1].mesh), 8 * 4 * 9.6, 1e-9);
}

TEST_F(Ldraw, ALineThatIsWrittenTwiceIsOnePart) {
  const std::string line = "1 4 0 0 0 1 0 0 0 1 0 0 0 1 brick.dat\n",
                    other = "1 4 0 0 0 1 0 0 0 1 0 0 0 -1 brick.dat\n";
  const std::string model = "0 Tower\n" + line + "0 STEP\n" + line + other + "0 STEP\n";
  const auto parts = read(model);
  ASSERT_EQ(parts.size(), 3u) << "nothing is left away in silence";
  EXPECT_TRUE(parts[0].problem.empty());
  EXPECT_TRUE(parts[1].by_meaning);
  EXPECT_NE(parts[1].problem.find("same line twice"), std::string::npos);
  EXPECT_TRUE(parts[2].problem.empty()) << "mirrored: another part";
  const auto steps = order(model);
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[1].parts, (std::vector<std::uint32_t>{2}));
}

/// Mirrored placements, INVERTNEXT and clockwise files: the outside stays outside.
TEST_F(Ldraw, TheOutsideStaysOutside) {
  write("library/parts/clockwise.dat", "0 Clockwise\n0 !LDRAW_ORG Part\n0 BFC CERTIFY CW\n" + box(20, 24, 10));
  write("library/parts/inner.dat",
        "0 Inner\n0 !LDRAW_ORG Part\n0 BFC CERTIFY CCW\n0 BFC INVERTNEXT\n"
        "1 16 0 0 0 1 0 0 0 1 0 0 0 1 brick.dat\n");
  write("library/parts/half.dat",
        "0 Half\n0 !LDRAW_ORG Part\n0 BFC CERTIFY CCW\n"
        "1 16 0 0 0 -1 0 0 0 1 0 0 0 1 brick.dat\n");
  const double volume = 8 * 4 * 9.6;
  for (const auto& [line, sign] :
       {std::pair("1 1 0 0 0 -1 0 0 0 1 0 0 0 1 brick.dat", 1), std::pair("1 1 0 0 0 -1 0 0 0 -1 0 0 0 1 brick.dat", 1),
        std::pair("1 1 0 0 0 1 0 0 0 1 0 0 0 1 inner.dat", -1), std::pair("1 1 0 0 0 -1 0 0 0 1 0 0 0 1 inner.dat", -1),
        std::pair("1 1 0 0 0 1 0 0 0 1 0 0 0 1 half.dat", 1), std::pair("1 1 0 0 0 1 0 0 0 1 0 0 0 -1 half.dat", 1),
        std::pair("1 1 0 0 0 1 0 0 0 1 0 0 0 1 clockwise.dat", -1)})  // its box is wound the other way
    EXPECT_NEAR(signed_volume(read("0 One\n" + std::string(line) + "\n")[0].mesh), sign * volume, 1e-9) << line;
  const Aabb mirrored = read("0 One\n1 1 0 0 0 -1 0 0 0 1 0 0 0 1 brick.dat\n")[0].mesh.box();
  EXPECT_NEAR(mirrored.lo.x(), -8, 1e-9);
  EXPECT_NEAR(mirrored.hi.x(), 0, 1e-9);
}

const char* const kModel =
    "0 FILE main.ldr\n0 Main\n1 4 0 0 0 1 0 0 0 1 0 0 0 1 brick.dat\n0 STEP\n"
    "1 1 0 -100 0 1 0 0 0 1 0 0 0 1 Cart.ldr\n0 ROTSTEP 180 0 0 ABS\n"
    "1 1 0 -200 0 0 -1 0 1 0 0 0 0 1 cart.ldr\n0 STEP\n0 STEP\n"
    "0 FILE cart.ldr\n0 Cart\n1 16 0 0 0 1 0 0 0 1 0 0 0 1 own.dat\n0 STEP\n1 16 0 -24 0 1 0 0 0 1 0 0 0 1 brick.dat\n"
    "1 16 0 -48 0 1 0 0 0 1 0 0 0 1 brick.dat\n"
    "0 FILE own.dat\n0 Own Part\n0 !LDRAW_ORG Unofficial_Part\n3 16 0 0 0 0 0 10 10 0 0\n3 16 0 0 0 10 0 0 0 10 0\n";

TEST_F(Ldraw, RoundedCornersOfFilesAreOne) {
  // A box of two halves whose common corners are rounded differently.
  const auto half = [](const std::string& x, const std::string& far) {
    const auto quad = [](const std::string& a, const std::string& b, const std::string& c, const std::string& d) {
      return "4 16 " + a + " " + b + " " + c + " " + d + "\n";
    };
    const std::string a = x + " 0 0", b = x + " 0 10", c = x + " 10 10", d = x + " 10 0";
    const std::string e = far + " 0 0", f = far + " 0 10", g = far + " 10 10", h = far + " 10 0";
    return quad(a, e, f, b) + quad(b, f, g, c) + quad(c, g, h, d) + quad(d, h, e, a) + quad(e, h, g, f);
  };
  write("library/parts/halves.dat", "0 Halves\n0 !LDRAW_ORG Part\n0 BFC CERTIFY CCW\n" + half("0.0004", "20") +
                                        "0 BFC INVERTNEXT\n1 16 0 0 0 -1 0 0 0 1 0 0 0 1 s/other.dat\n");
  write("library/parts/s/other.dat", "0 Other\n0 !LDRAW_ORG Subpart\n0 BFC CERTIFY CCW\n" + half("0.0031", "20"));
  const auto parts = read("0 Model\n1 4 0 0 0 1 0 0 0 1 0 0 0 1 halves.dat\n");
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].mesh.vertices.size(), 12u);
}

TEST_F(Ldraw, SubModelsAreGroupsAndEmbeddedFilesParts) {
  const auto parts = read(kModel);
  ASSERT_EQ(parts.size(), 7u);
  EXPECT_EQ(parts[1].name, "Own Part");
  EXPECT_EQ(parts[1].parents, std::vector<std::string>{"cart.ldr"});
  EXPECT_EQ(parts[4].instances.front(), "cart.ldr#2");
  EXPECT_NE(parts[2].instances.back(), parts[3].instances.back());
  EXPECT_TRUE(parts[0].parents.empty());
}

TEST_F(Ldraw, StepsArePeoplesOrder) {
  const auto steps = order(kModel);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), right = Eigen::Vector3d::UnitX();
  const std::vector<ReferenceStep> expected{
      {1, {0}, "", up},        {1, {1}, "cart.ldr", up},      {2, {2, 3}, "cart.ldr", up},
      {2, {1, 2, 3}, "", -up}, {1, {4}, "cart.ldr#2", right}, {2, {5, 6}, "cart.ldr#2", right},
      {3, {4, 5, 6}, "", -up},
  };
  ASSERT_EQ(steps.size(), expected.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_EQ(steps[i].step, expected[i].step) << i;
    EXPECT_EQ(steps[i].parts, expected[i].parts) << i;
    EXPECT_EQ(steps[i].group, expected[i].group) << i;
    EXPECT_LT((steps[i].up - expected[i].up).norm(), 1e-9) << i << ": " << steps[i].up.transpose();
  }
}

TEST_F(Ldraw, WhatIsMissingIsNamed) {
  write("library/parts/broken.dat", "0 Broken\n0 !LDRAW_ORG Part\n1 16 0 0 0 1 0 0 0 1 0 0 0 1 s\\gone.dat\n");
  const auto parts = read(
      "0 Model\n1 4 0 0 0 1 0 0 0 1 0 0 0 1 brick.dat\n1 4 0 0 0 1 0 0 0 1 0 0 0 1 none.dat\n"
      "1 4 0 0 0 1 0 0 0 1 0 0 0 1 broken.dat\n1 4 0 0 0 1 0 0 0 1 0 0 0 1 ../../secret.dat\n"
      "1 4 0 0 0 1 0 0 0 0 0 0 0 1 brick.dat\n");
  ASSERT_EQ(parts.size(), 5u);
  EXPECT_EQ(parts[0].problem, "");
  EXPECT_NE(parts[1].problem.find("'none.dat' is neither in the file nor in the library"), std::string::npos);
  EXPECT_NE(parts[2].problem.find("'s/gone.dat'"), std::string::npos) << parts[2].problem;
  EXPECT_NE(parts[3].problem.find("leads out of the folder"), std::string::npos);
  EXPECT_NE(parts[4].problem.find("no volume"), std::string::npos);
}

TEST_F(Ldraw, FilesThatAreNotReadSayWhere) {
  for (const auto& [text, problem] :
       {std::pair("0 Model\n1 4 0 0 zero 1 0 0 0 1 0 0 0 1 brick.dat\n", "line 2: 'zero' is no number"),
        std::pair("0 Model\n9 4 0 0\n", "line 2: '9' is no type of line"),
        std::pair("0 FILE a.ldr\n0 A\n1 4 0 0 0 1 0 0 0 1 0 0 0 1 a.ldr\n", "refers to itself"),
        std::pair("0 FILE a.ldr\n0 A\n0 FILE a.ldr\n0 A\n", "is there twice")}) {
    try {
      read(text);
      FAIL() << text;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(problem), std::string::npos) << e.what();
    }
  }
}

/// Twenty files, each of which refers twice to the next: a million boxes are counted, not built.
TEST_F(Ldraw, FilesThatExplodeAreCountedFirst) {
  std::string text = "0 Model\n1 4 0 0 0 1 0 0 0 1 0 0 0 1 b0.dat\n";
  for (int k = 0; k < 30; ++k)
    write("library/parts/b" + std::to_string(k) + ".dat", "0 B\n0 !LDRAW_ORG Part\n" + (k == 29 ? box(1, 1, 1) : [&] {
                                                            const std::string next = "1 16 0 0 0 1 0 0 0 1 0 0 0 1 b" +
                                                                                     std::to_string(k + 1) + ".dat\n";
                                                            return next + next;
                                                          }()));
  write("model.mpd", text);
  EXPECT_EQ(LdrawImporter().count_triangles(folder_ / "model.mpd"), (std::uint64_t{1} << 29) * 12);
  EXPECT_THROW(read(text), InputError);
}

/// The text of `levels` files, each of which uses the next one `uses` times; the last one holds `last`.
std::string nested(const std::string& ending, int levels, int uses, const std::string& last) {
  std::string out;
  for (int i = 0; i <= levels; ++i) {
    out += "0 FILE n" + std::to_string(i) + ending + "\n0 Nested\n";
    for (int use = 0; i < levels && use < uses; ++use)
      out += "1 16 " + std::to_string(use) + " 0 0 1 0 0 0 1 0 0 0 1 n" + std::to_string(i + 1) + ending + "\n";
  }
  return out + last;
}

TEST_F(Ldraw, NestingThatMultipliesOrNeverEndsIsRefused) {
  const std::string use = "0 Model\n1 4 0 0 0 1 0 0 0 1 0 0 0 1 brick.dat\n1 4 0 0 0 1 0 0 0 1 0 0 0 1 n0";
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      const auto parts = read(text);
      return parts.size() == 2 ? parts[1].problem : "";
    } catch (const InputError& e) {
      return e.what();
    }
  };
  // Neither has triangles, which are counted before.
  EXPECT_NE(refusal(use + ".ldr\n" + nested(".ldr", 40, 2, "")).find("more than 1000000"), std::string::npos);
  EXPECT_NE(refusal(use + ".dat\n" + nested(".dat", 40, 2, "")).find("more than 1000000"), std::string::npos);
  EXPECT_NE(refusal(use + ".dat\n" + nested(".dat", 50'000, 1, box(1, 1, 1))).find("200 deep"), std::string::npos);
}

TEST_F(Ldraw, ByteOrderMarksAndLineEndsOfOldMacs) {
  const std::string text = "0 Tower\n1 4 0 0 0 1 0 0 0 1 0 0 0 1 brick.dat\n1 4 0 24 0 1 0 0 0 1 0 0 0 1 brick.dat\n";
  EXPECT_EQ(read("\xEF\xBB\xBF" + text).size(), 2u);
  std::string mac = text;
  std::replace(mac.begin(), mac.end(), '\n', '\r');
  EXPECT_EQ(read(mac).size(), 2u);
}

}  // namespace
}  // namespace dismantle::ldraw
