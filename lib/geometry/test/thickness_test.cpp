// Thickness is measured to where the solid ends.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/testing/trials.h"

namespace dismantle::geometry {
namespace {

using shapes::Vec3;

/// The body that a closed outline of (radius, height) sweeps about z; its first and last points are on the axis.
Mesh turned(const std::vector<std::pair<double, double>>& outline, std::uint32_t around) {
  Mesh m;
  m.vertices.emplace_back(0, 0, outline.front().second);
  for (std::size_t k = 1; k + 1 < outline.size(); ++k)
    for (std::uint32_t i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around, r = outline[k].first;
      m.vertices.emplace_back(r * std::cos(a), r * std::sin(a), outline[k].second);
    }
  m.vertices.emplace_back(0, 0, outline.back().second);
  const auto rows = static_cast<std::uint32_t>(outline.size() - 2), last = rows * around + 1;
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t j = (i + 1) % around, top = (rows - 1) * around + 1;
    m.triangles.push_back({0, 1 + j, 1 + i});
    for (std::uint32_t k = 0; k + 1 < rows; ++k) {
      const std::uint32_t a = k * around + 1, b = a + around;
      m.triangles.push_back({a + i, a + j, b + j});
      m.triangles.push_back({a + i, b + j, b + i});
    }
    m.triangles.push_back({top + i, top + j, last});
  }
  return m;
}

/// Thickness of the triangles that face down at a height.
std::vector<double> thickness_below(const Mesh& mesh, double reach, const Pose& pose, double height) {
  std::vector<double> found;
  for (Solid& s : split_into_solids(shapes::moved(mesh, pose))) {
    s.measure_thickness(reach);
    for (std::uint32_t t = 0; t < s.mesh.triangles.size(); ++t) {
      const Pose back = pose.inverse() * s.frame;
      const Vec3 middle = back * Vec3((s.mesh.vertex(t, 0) + s.mesh.vertex(t, 1) + s.mesh.vertex(t, 2)) / 3);
      if (std::abs(middle.z() - height) < 1e-6 && (back.q * s.normals[t]).z() < -0.99) found.push_back(s.thickness[t]);
    }
  }
  return found;
}

TEST(Thickness, AToothThatEndsOnItsHeadIsNoWallWithoutThickness) {
  Rng rng(1);
  for (int trial = 0; trial < testing_support::trials(4, 40); ++trial) {
    const Pose pose = shapes::random_pose(rng, 5);
    // The outline turns back at height 0: the end of a tooth of radius 1 lies on the underside of the head.
    const Mesh mesh = turned({{0, -1}, {1, -1}, {1, 0}, {0.5, 0}, {2, 0}, {2, 1}, {0, 1}}, 24);
    const std::vector<double> head = thickness_below(mesh, 0.5, pose, 0);
    ASSERT_EQ(head.size(), 48U);
    for (const double t : head) EXPECT_GT(t, 0.5) << "trial " << trial;
    for (const double t : thickness_below(mesh, 1.5, pose, 0)) EXPECT_NEAR(t, 1, 1e-6) << "trial " << trial;
  }
}

/// A box of height 1 on z = 0. Between its lower outline and the middle of its underside, the face is folded: the strip
/// joins corners of the outline and of the middle that do not lie opposite each other, `shift` corners apart.
Mesh with_folded_underside(std::uint32_t shift) {
  Mesh m;
  for (const double half : {2.0, 1.0})
    for (std::uint32_t k = 0; k < 4; ++k)
      m.vertices.emplace_back(k == 0 || k == 3 ? half : -half, k < 2 ? half : -half, 0);
  for (std::uint32_t k = 0; k < 4; ++k) m.vertices.emplace_back(m.vertices[k] + Vec3(0, 0, 1));
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t n = (k + 1) % 4, a = 4 + (k + shift) % 4, b = 4 + (n + shift) % 4;
    m.triangles.push_back({n, k, a});
    m.triangles.push_back({n, a, b});
    m.triangles.push_back({k, n, 8 + n});
    m.triangles.push_back({k, 8 + n, 8 + k});
  }
  for (const std::uint32_t first : {1U, 2U}) {
    m.triangles.push_back({4, 4 + first + 1, 4 + first});
    m.triangles.push_back({8, 8 + first, 8 + first + 1});
  }
  return m;
}

TEST(Thickness, AFaceFoldedWithinItsPlaneIsNoWallWithoutThickness) {
  Rng rng(3);
  for (int trial = 0; trial < testing_support::trials(4, 40); ++trial) {
    const Pose pose = shapes::random_pose(rng, 5);
    for (const std::uint32_t shift : {0U, 1U, 2U, 3U})
      for (Solid& s : split_into_solids(shapes::moved(with_folded_underside(shift), pose))) {
        s.measure_thickness(0.5);
        for (const double t : s.thickness) EXPECT_GT(t, 0.5) << "trial " << trial << ", shift " << shift;
      }
  }
}

TEST(Thickness, AThinWallIsMeasuredToItsOtherSide) {
  Rng rng(2);
  for (int trial = 0; trial < testing_support::trials(4, 40); ++trial) {
    const double wall = std::pow(10, rng.uniform(-6, -1));
    const Pose pose = shapes::random_pose(rng, 5);
    // A disc with a second disc above it, both thin, joined at the axis by a peg.
    const Mesh mesh =
        turned({{0, 0}, {2, 0}, {2, wall}, {0.5, wall}, {0.5, 0.3}, {2, 0.3}, {2, 0.3 + wall}, {0, 0.3 + wall}}, 24);
    for (const double height : {0.0, 0.3}) {
      const std::vector<double> found = thickness_below(mesh, 0.2, pose, height);
      ASSERT_FALSE(found.empty());
      for (const double t : found) {
        if (height == 0 && t > 1) continue;  // over the peg
        EXPECT_NEAR(t, wall, 1e-7) << "trial " << trial;
      }
    }
  }
}

}  // namespace
}  // namespace dismantle::geometry
