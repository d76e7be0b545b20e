// The verifier on parts whose surface is open: what is a wall, what is an opening, how deep a pair is in each other.
#include <gtest/gtest.h>

#include "dismantle/testing/held_shapes.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {
namespace {

using shapes::Vec3;

constexpr double kAllowed = 0.01;

Mesh cup() {
  Mesh m = shapes::box({-2, -2, 0}, {2, 2, 3});
  std::erase_if(m.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](auto v) { return m.vertices[v].z() > 2; });
  });
  return m;
}

Mesh sheet(double half, double z) {
  return {{{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// The first part is open or the second, or both; depth: of their initial overlap.
Assembly pair_of(const Mesh& a, const Mesh& b, double depth = 0) {
  Assembly made = shapes::assembly_of({a, b});
  for (Part& part : made.parts) part.open = true;
  if (depth > 0) made.overlaps.push_back({0, 1, depth});
  return made;
}

bool passes(const Verifier& verifier, const std::vector<Vec3>& displacement) {
  Path path{{Pose{}}};
  for (const Vec3& t : displacement) path.push_back({shapes::shift(t)});
  return verifier.check_motion({0}, {{1, Pose{}}}, path).valid;
}

TEST(OpenParts, LeaveThroughTheOpeningAndNotThroughTheWall) {
  for (const Mesh& mover :
       {shapes::box({-2, -2, 0}, {2, 2, 2}), shapes::box({-1, -1, 0}, {1, 1, 5}), sheet(1.9, 0.02), sheet(1, 1)}) {
    const Verifier verifier(pair_of(mover, cup()), {kAllowed});
    EXPECT_TRUE(passes(verifier, {{0, 0, 8}}));
    EXPECT_FALSE(passes(verifier, {{0, 0, -8}}));
    EXPECT_FALSE(passes(verifier, {{8, 0, 0}}));
    EXPECT_TRUE(passes(verifier, {{0, 0, 8}, {9, 0, 8}, {9, 0, -8}, {0, 0, -8}, {0, 0, -6}}));
    EXPECT_FALSE(passes(verifier, {{0, 0, 8}, {9, 0, 8}, {9, 0, -8}, {0, 0, -8}, {0, 0, 0}})) << "from below";
  }
}

TEST(OpenParts, SheetsInContactOnBothSidesSlide) {
  // A slot whose walls touch the sheet on both sides.
  const Verifier verifier(
      pair_of(sheet(1, 1), shapes::joined(shapes::box({-2, -2, 0}, {2, 2, 1}), shapes::box({-2, -2, 1}, {2, 2, 2}))),
      {kAllowed});
  EXPECT_TRUE(passes(verifier, {{5, 0, 0}}));
  EXPECT_FALSE(passes(verifier, {{0, 0, 5}}));
}

TEST(OpenParts, DoNotCreepThroughAWallInSmallSteps) {
  const Verifier verifier(pair_of(sheet(1, 0.001), sheet(2, 0)), {kAllowed});
  // Behind the wall by half of what is allowed: it may be there on its way, not at rest, where no path tells its side.
  EXPECT_TRUE(passes(verifier, {{0, 0, -0.005}, {0, 0, 0.001}}));
  EXPECT_FALSE(passes(verifier, {{0, 0, -0.005}}));
  EXPECT_FALSE(passes(verifier, {{0, 0, -0.02}, {0, 0, 0.001}}));
}

TEST(OpenParts, AreAsDeepAsTheSmallestDisplacementThatFreesThem) {
  const double tolerance = 1e-4;
  for (const double depth : {0.002, 0.03, 0.4}) {
    // A block sunk into the floor of a cup; its vertices move along the diagonal of its corners, so up to sqrt(3)
    // times.
    const Mesh block = shapes::box({-1, -1, -depth}, {1, 1, 2}), plate = sheet(1, 0);
    const double found = penetration_depth(block, Pose{}, cup(), Pose{}, tolerance);
    EXPECT_GE(found, depth - tolerance);
    EXPECT_LE(found, std::sqrt(3.0) * depth + 2 * tolerance);
    EXPECT_EQ(penetration_depth(plate, shapes::shift({0, 0, depth}), cup(), Pose{}, tolerance), 0) << "not crossing";
    const Verifier verifier(pair_of(block, cup(), found), {kAllowed});
    EXPECT_TRUE(passes(verifier, {{0, 0, 6}})) << depth;
    EXPECT_FALSE(passes(verifier, {{0, 0, -6}})) << depth;
    EXPECT_FALSE(passes(verifier, {{6, 0, 0}})) << depth;
  }
}

/// A shaft along z with three flanges: the upper end of the middle one is at `depth`.
Mesh flanges(double depth, double thickness, double gap) {
  std::vector<std::pair<double, double>> outline{{0.2, -4}, {1, -4}};
  for (const int k : {-1, 0, 1}) {
    const double top = depth + k * (thickness + gap);
    for (const auto& [r, z] : {std::pair{1.0, top - thickness}, {2.0, top - thickness}, {2.0, top}, {1.0, top}})
      outline.emplace_back(r, z);
  }
  outline.insert(outline.end(), {{1, 4}, {0.2, 4}});
  return shapes::lathe(outline, 24);
}

TEST(OpenParts, AreNoDeeperThanTheNearestOfManyWalls) {
  // The sheet cuts into a flange. Displaced by more than the gap, it meets the next one; displaced by more than half of
  // their thickness, the flanges are inside out.
  const double depth = 0.055, tolerance = 1e-4;
  const Mesh cut = shapes::moved(sheet(0.7, 0), shapes::shift({2.2, 0, 0}));
  const double found = penetration_depth(cut, Pose{}, flanges(depth, 0.12, 0.008), Pose{}, tolerance);
  EXPECT_GE(found, depth - tolerance);
  EXPECT_LE(found, depth + 2 * tolerance);
}

TEST(OpenParts, AreNoDeeperThanTheyAreLarge) {
  // A rod through both sheets of a part: no displacement of either suffices, however long.
  const Mesh sheets = shapes::joined(sheet(1, 0.1), sheet(1, 0.2)), rod = shapes::box({-0.1, -0.2, -3}, {0.1, 0.2, 3});
  EXPECT_LE(penetration_depth(rod, Pose{}, sheets, Pose{}, 1e-4), 0.2);
}

TEST(OpenParts, AThinPartThatTouchesAWallIsNotSaidToCut) {
  // Its copy is displaced by no more than a share of its thickness, so a meeting proves nothing about the limit.
  for (const double thickness : {1e-4, 1e-3}) {
    Assembly pair = pair_of(shapes::box({-1, -1, 0}, {1, 1, thickness}), cup());
    pair.parts[0].open = false;
    const Verifier verifier(pair, {kAllowed});
    const MotionCheck down = verifier.check_motion({0}, {{1, Pose{}}}, {{Pose{}}, {shapes::shift({0, 0, -5})}});
    ASSERT_TRUE(down.violation.has_value());
    EXPECT_TRUE(down.violation->uncertain || down.violation->depth >= kAllowed * (1 - 1e-6)) << down.violation->depth;
  }
}

TEST(OpenParts, CrossedSheetsHaveADepth) {
  const Mesh upright{{{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_GT(penetration_depth(sheet(1, 0.5), Pose{}, upright, Pose{}, 1e-4), 0.4);
}

}  // namespace
}  // namespace dismantle
