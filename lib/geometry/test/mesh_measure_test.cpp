#include "dismantle/geometry/mesh_measure.h"

#include <gtest/gtest.h>

#include "dismantle/geometry/mesh_subdivide.h"
#include "dismantle/testing/mesh_damage.h"

namespace dismantle {
namespace {

using namespace shapes;

double smallest_angle(const Mesh& m) {
  double least = std::numbers::pi;
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) {
      const Vec3 a = m.vertex(t, (c + 1) % 3) - m.vertex(t, c), b = m.vertex(t, (c + 2) % 3) - m.vertex(t, c);
      least = std::min(least, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  return least;
}

TEST(Subdivide, KeepsTheSurfaceClosedAndEdgesShort) {
  Rng rng(11);
  for (int round = 0; round < 40; ++round) {
    const Mesh m = random_solid(rng);
    const double limit = rng.uniform(0.08, 1.5);
    const Mesh fine = subdivide(m, limit);
    EXPECT_LE(longest_edge(fine), limit * (1 + 1e-12));
    EXPECT_TRUE(edge_use(fine).closed());
    EXPECT_EQ(edge_use(fine).crowded, 0u);
    EXPECT_NEAR(signed_volume(fine), signed_volume(m), 1e-10);
    EXPECT_NEAR(surface_area(fine), surface_area(m), 1e-9);
    EXPECT_GE(smallest_angle(fine), 0.5 * smallest_angle(m) * (1 - 1e-9));
    for (std::size_t i = 0; i < m.vertices.size(); ++i) ASSERT_EQ(fine.vertices[i], m.vertices[i]);
  }
}

TEST(Subdivide, LeavesFineMeshesAlone) {
  const Mesh m = box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(subdivide(m, 2).triangles, m.triangles);
}

TEST(Subdivide, RefusesWhatWouldNotFit) {
  EXPECT_NE(input_error([] {
              subdivide(box({0, 0, 0}, {1, 1, 1}), 0.001, 10'000);
            }).find("more than 10000 triangles"),
            std::string::npos);
}

TEST(Measure, VolumeOfKnownShapesAnywhere) {
  Rng rng(12);
  for (int round = 0; round < 50; ++round) {
    const Vec3 size = random_vector(rng, 0.1, 3);
    const Mesh m = moved(box(Vec3::Zero(), size), random_pose(rng, 1e5));
    EXPECT_NEAR(signed_volume(m), size.prod(), 1e-8);
    EXPECT_NEAR(surface_area(m), 2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x()), 1e-8);
  }
}

TEST(Measure, EdgeUseTellsOpenFromInconsistent) {
  Mesh m = box({0, 0, 0}, {1, 1, 1});
  EXPECT_TRUE(edge_use(m).closed());
  flip(m, 3);
  EXPECT_EQ(edge_use(m).inconsistent, 3u);
  EXPECT_EQ(edge_use(m).open, 0u);
  m.triangles.erase(m.triangles.begin() + 3);
  EXPECT_EQ(edge_use(m).open, 3u);
  EXPECT_EQ(edge_use(m).inconsistent, 0u);
}

TEST(Measure, ShellsAreCounted) {
  Mesh m = box({0, 0, 0}, {1, 1, 1});
  append(m, sphere({5, 0, 0}, 1, 1));
  std::size_t count = 0;
  const auto shell = shells_of(m, count);
  EXPECT_EQ(count, 2u);
  EXPECT_EQ(shell.front(), 0u);
  EXPECT_EQ(shell.back(), 1u);
}

TEST(Measure, OrientedBoxOfATurnedBox) {
  Rng rng(13);
  for (int round = 0; round < 50; ++round) {
    Vec3 size = random_vector(rng, 0.01, 3);
    const Mesh m = moved(box(Vec3::Zero(), size), random_pose(rng, 10));
    std::sort(size.data(), size.data() + 3);
    EXPECT_LT((oriented_box(m) - size).norm(), 1e-9);
  }
}

TEST(Measure, CrossingsAreFoundAndTouchingIsNone) {
  Rng rng(14);
  for (int round = 0; round < 30; ++round) {
    Mesh apart = random_solid(rng);
    EXPECT_TRUE(self_crossings(apart, 10).empty());
    Mesh crossing = apart;
    append(crossing, moved(apart, shift(0.05 * apart.box().size())));
    EXPECT_FALSE(self_crossings(crossing, 10).empty());
  }
  Mesh touching = box({0, 0, 0}, {1, 1, 1});
  append(touching, box({1, 0.25, 0.25}, {2, 0.75, 0.75}));
  EXPECT_TRUE(self_crossings(touching, 10).empty());
}

TEST(TriangulatePolygon, CoversRandomStarsExactly) {
  Rng rng(15);
  for (int round = 0; round < 200; ++round) {
    const auto n = 3 + rng.below(100);
    std::vector<Vec3> corners;
    const Pose pose = random_pose(rng, 10);
    double area = 0;
    std::vector<Vec3> flat;
    for (std::uint64_t i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
      flat.push_back(rng.uniform(0.2, 1) * Vec3(std::cos(a), std::sin(a), 0));
    }
    for (std::size_t i = 0; i < n; ++i) area += flat[i].cross(flat[(i + 1) % n]).z() / 2;
    for (const auto& p : flat) corners.push_back(pose * p);
    const auto cut = triangulate_polygon(corners);
    ASSERT_EQ(cut.size(), n - 2);
    double sum = 0;
    const Vec3 normal = pose.q * Vec3::UnitZ();
    for (const auto& t : cut) {
      const double part = (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]).dot(normal) / 2;
      EXPECT_GT(part, -1e-9);
      sum += part;
    }
    EXPECT_NEAR(sum, area, 1e-8);
  }
}

TEST(TriangulatePolygon, RefusesPolygonsWithoutArea) {
  const std::vector<Vec3> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}};
  EXPECT_TRUE(triangulate_polygon(line).empty());
  EXPECT_TRUE(triangulate_polygon(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}}).empty());
}

}  // namespace
}  // namespace dismantle
