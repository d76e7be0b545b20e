// What a forced step says of itself without a proof, and which line of a configuration it suggests.
#include "forced_reason.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "dismantle/testing/fake_planning.h"
#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

using fake::assembly_of;

constexpr double kTolerance = 0.01;
const std::vector<Pose> kUp{Pose{}, shapes::shift({0, 0, 20})};

struct Said {
  std::string what, line;
};

/// Part 0 moves up past part 1.
Said said(const Assembly& assembly, double depth, const std::vector<Pose>& path = kUp) {
  const MotionDepth deepest{0, 1, depth, assembly.initial_overlap(0, 1)};
  return {hindrance_text(assembly, deepest, path, {1, Pose{}}, kTolerance),
          suggestion_text(assembly, deepest, kTolerance)};
}

Assembly two_blocks() {
  return assembly_of({{"block", {{{0, 0, 0}, {2, 2, 2}}}}, {"housing", {{{0, 0, 2.1}, {4, 4, 4}}}}});
}

TEST(ForcedReason, AShallowOneIsASnapAndADeepOneIsNot) {
  const Said shallow = said(two_blocks(), 0.104), deep = said(two_blocks(), 1.5);
  EXPECT_EQ(shallow.what, "snap: 'block' or 'housing' would have to bend by 0.1 on the way");
  EXPECT_EQ(shallow.line, "constraints: {accept: [{part: 'block', against: 'housing', as: snap, depth: 0.11}]}");
  EXPECT_EQ(deep.what, "'block' would have to go 1.5 deep through 'housing'");
  EXPECT_EQ(deep.line, "");
}

/// A motion that was refused for want of a proof cuts nothing: nothing would have to bend by 1e-15.
TEST(ForcedReason, WhatIsNoDeeperThanAllowedIsUnproved) {
  for (const double depth : {-2e-15, 0.0, 1e-15, 0.5 * kTolerance, kTolerance}) {
    const Said none = said(two_blocks(), depth);
    EXPECT_NE(none.what.find("no proof that 'block' stays out of 'housing'"), std::string::npos) << none.what;
    EXPECT_EQ(none.line, "");
  }
}

TEST(ForcedReason, LengthsAreThoseOfTheInput) {
  Assembly assembly = two_blocks();
  assembly.normalization.scale = 0.1;
  EXPECT_NE(said(assembly, 0.104).what.find("by 1 on the way"), std::string::npos);
  EXPECT_NE(said(assembly, 0.104).line.find("depth: 1.1}"), std::string::npos);
}

/// With the suggested depth the step is accepted: it is never below the measured one.
TEST(ForcedReason, TheSuggestedDepthIsEnough) {
  for (double depth = 0.02; depth < 0.3; depth *= 1.07) {
    const std::string line = said(two_blocks(), depth).line;
    const double written = std::stod(line.substr(line.find("depth: ") + 7));
    EXPECT_GE(written, depth);
    EXPECT_LE(written, 1.11 * depth);
  }
}

TEST(ForcedReason, WhatOverlapsAboutAsMuchWhenAssembledIsPressed) {
  Assembly assembly = two_blocks();
  assembly.overlaps = {{0, 1, 0.05}};
  const Said near = said(assembly, 0.08), far = said(assembly, 0.15);
  EXPECT_EQ(near.what,
            "pressed: 'block' and 'housing' are in each other by 0.05 when assembled, and by 0.08 on the way");
  EXPECT_EQ(near.line, "constraints: {overlap: [{parts: ['block', 'housing'], depth: 0.081}]}");
  EXPECT_EQ(far.what.substr(0, 4), "snap");
}

TEST(ForcedReason, ARoundPartIsComparedWithTheOpening) {
  const Mesh rod = shapes::joined(shapes::tube(0, 0.5, -3, 3, 32), shapes::tube(0, 1, 3.01, 3.5, 32));
  for (const double hole : {0.6, 0.8}) {
    Assembly assembly = shapes::assembly_of({rod, shapes::tube(hole, 2, -1, 1, 32)});
    const std::vector<Pose> down{Pose{}, shapes::shift({0, 0, -20})};
    EXPECT_EQ(
        said(assembly, 1 - hole, down).what,
        fmt::format("'part0', of radius 1 about the way out, does not pass the opening of radius {} of 'part1'", hole));
    const std::vector<Pose> sideways{Pose{}, shapes::shift({20, 0, 0})};
    EXPECT_EQ(said(assembly, 1 - hole, sideways).what.find("radius"), std::string::npos);
    assembly.parts[1].mesh = std::make_shared<const Mesh>(shapes::tube(1.1, 2, -1, 1, 32));  // it passes
    EXPECT_EQ(said(assembly, 1 - hole, down).what.find("radius"), std::string::npos);
  }
}

TEST(ForcedReason, AThinPartIsSuggestedAsFlexibleWhereItsThicknessIsCut) {
  const Assembly assembly =
      assembly_of({{"it's thin", {{{0, 0, 0}, {2, 2, 0.1}}}}, {"block", {{{0, 0, 1}, {0.2, 0.2, 1.2}}}}});
  EXPECT_EQ(said(assembly, 0.15).line, "constraints: {flexible: ['it''s thin']}");
  EXPECT_EQ(said(assembly, 0.5).line, "");
}

}  // namespace
}  // namespace dismantle
