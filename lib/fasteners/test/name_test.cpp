#include "dismantle/fasteners/name.h"

#include <gtest/gtest.h>

#include <vector>

namespace dismantle::fasteners {
namespace {

struct Case {
  const char* name;
  std::optional<Kind> kind;
  const char* thread;
  double length;
};

TEST(RecogniseName, ReadsStandardsWordsAndSizes) {
  using enum Kind;
  const std::vector<Case> cases{
      {"ISO 4762 M6x20 - 20N", screw, "M6", 20},
      {"DIN912 M4x16#3", screw, "M4", 16},
      {"Low Profile Screw M5_M5 x 25", screw, "M5", 25},
      {"HI_WUERTH 00824  20 cylinder head screw DIN 912 M4x20 8.8 BLK", screw, "M4", 20},
      {"_Knurled screw DIN 464-M5-12-ZB", screw, "M5", 12},
      {"Zylinderschraube M5 x 0.8 x 16", screw, "M5", 16},
      {"Vis CHC M4x12", screw, "M4", 12},
      {"ANSI B18.2.1 - 1/4-20 UNC", screw, "1/4-20", 0},
      {"#6-32 x 1/2 pan head screw", screw, "#6-32", 12.7},
      {"M2x10", screw, "M2", 10},
      {"Sechskantmutter M8", nut, "M8", 0},
      {"Nylon Insert Lock Nut M5", nut, "M5", 0},
      {"DIN EN ISO 7089 - 8,4", washer, "", 0},
      {"rondelle plate M6", washer, "M6", 0},
      {"parallel pin ISO 8734 2m6x20 Blank", pin, "", 20},
      {"O-ring 20x2", ring, "", 0},
      {"8mm leadscrew 290mm", shaft, "", 0},
      {"Motor Mount Plate Nema 17", plate, "", 0},
      {"Flexible Coupling 0.25in x 8mm", coupling, "", 0},
      // Words of a kind inside a name for something else.
      {"screw cover", std::nullopt, "", 0},
      {"Motor mount", std::nullopt, "", 0},
      {"gear_base", std::nullopt, "", 0},
      {"Base screw", screw, "", 0},
      {"JST - XH - Thru - 2Pin - 2.5mm", std::nullopt, "", 0},
      {"Pin header 2x20", std::nullopt, "", 0},
      {"03_pin", pin, "", 0},
      {"Verschraubung", screw, "", 0},
      {"Spring plunger GN 615.3-M3-K", std::nullopt, "M3", 0},
      {"M10x1.25", std::nullopt, "M10", 0},  // a fine thread, no length
      {"part_12", std::nullopt, "", 0},
      {"", std::nullopt, "", 0},
  };
  for (const Case& c : cases) {
    const NameSays said = recognise_name(c.name);
    EXPECT_EQ(said.kind, c.kind) << c.name;
    EXPECT_EQ(said.thread, c.thread) << c.name;
    EXPECT_NEAR(said.length, c.length, 1e-9) << c.name;
    EXPECT_EQ(said.kind.has_value(), said.confidence > 0 && !said.reason.empty() && said.kind.has_value()) << c.name;
  }
}

TEST(RecogniseName, KindsHaveTheirOwnNames) {
  for (const auto name : kKindNames) EXPECT_EQ(to_string(*kind_from_string(name)), name);
  EXPECT_EQ(kind_from_string("bolt"), Kind::screw);
  EXPECT_FALSE(kind_from_string("thing"));
}

}  // namespace
}  // namespace dismantle::fasteners
