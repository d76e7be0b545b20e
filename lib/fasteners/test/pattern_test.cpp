// Patterns of equal screws: which belong together, and their order.
#include "dismantle/fasteners/pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dismantle::fasteners {
namespace {

using Eigen::Vector3d;

/// Screws at these places above part 0, which they all clamp.
struct Screws {
  Assembly assembly;
  std::vector<Shape> shapes;
  std::vector<Fastening> fastenings;
  explicit Screws(const std::vector<Vector3d>& places) {
    assembly.parts.resize(places.size() + 1);
    shapes.resize(places.size() + 1);
    for (PartId i = 1; i <= places.size(); ++i) {
      assembly.parts[i].kind = PartKind{"screw", "M3x10", 1};
      shapes[i].kind = Kind::screw;
      shapes[i].top = places[i - 1];
      fastenings.push_back({.screw = i, .clamps = {0}, .into = {0}});
    }
  }
  std::vector<Pattern> found() const { return patterns_of(assembly, fastenings, shapes); }
};

std::vector<Vector3d> on_circle(int n, double turn = 0.3) {
  std::vector<Vector3d> out;
  for (int k = 0; k < n; ++k) {
    const double angle = turn + 2 * std::numbers::pi * k / n;
    out.emplace_back(20 * std::cos(angle), 20 * std::sin(angle), 1);
  }
  return out;
}

TEST(Pattern, EachScrewIsFollowedByTheOneOpposite) {
  for (const int n : {4, 6, 8, 12}) {
    const Screws s(on_circle(n));
    const auto found = s.found();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].size, "M3x10");
    EXPECT_EQ(found[0].screws.front(), 1u);
    for (int k = 0; k < n; k += 2)
      EXPECT_NEAR((s.shapes[found[0].screws[k]].top - s.shapes[found[0].screws[k + 1]].top).norm(), 40, 1e-9);
  }
  const auto five = Screws(on_circle(5)).found();
  ASSERT_EQ(five.size(), 1u);
  EXPECT_EQ(five[0].screws, (std::vector<PartId>{1, 3, 5, 2, 4}));
}

TEST(Pattern, FewScrewsOrARowAreNone) {
  EXPECT_TRUE(Screws(on_circle(3)).found().empty());
  EXPECT_TRUE(Screws({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {30, 0.5, 0}}).found().empty());
  Screws other(on_circle(4));
  other.assembly.parts[2].kind->size = "M4x10";
  EXPECT_TRUE(other.found().empty());
  Screws unknown(on_circle(4));
  for (Part& part : unknown.assembly.parts)
    if (part.kind) part.kind->size = "?x10";
  EXPECT_TRUE(unknown.found().empty());
  Screws against(on_circle(4));
  against.shapes[3].axis = -against.shapes[3].axis;
  EXPECT_TRUE(against.found().empty());
}

TEST(Pattern, WashersAndSpacersAreEachScrewsOwn) {
  Screws s(on_circle(4));
  const auto washer = static_cast<PartId>(s.assembly.parts.size());
  s.assembly.parts.resize(washer + 1);
  s.shapes.resize(washer + 1);
  s.shapes[washer].kind = Kind::washer;
  s.fastenings[1].clamps = {washer, 0};
  const auto found = s.found();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].clamps, std::vector<PartId>{0});
}

}  // namespace
}  // namespace dismantle::fasteners
