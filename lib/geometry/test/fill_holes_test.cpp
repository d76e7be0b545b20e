#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/mesh_repair.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/testing/mesh_damage.h"

namespace dismantle {
namespace {

using namespace shapes;

TEST(FillHoles, SmallFlatHolesAreClosed) {
  Rng rng(7);
  for (int round = 0; round < 40; ++round) {
    Mesh m = sphere(Vec3::Zero(), 1, 3);
    const double volume = signed_volume(m);
    const auto center = static_cast<std::uint32_t>(rng.below(m.vertices.size()));
    std::erase_if(m.triangles, [&](const Triangle& t) { return t[0] == center || t[1] == center || t[2] == center; });
    weld(m, 0);
    const auto holes = fill_holes(m, {});
    EXPECT_EQ(holes.size(), 1u);
    for (const Hole& h : holes) EXPECT_TRUE(h.filled) << h.why_not;
    EXPECT_TRUE(edge_use(m).closed());
    EXPECT_NEAR(signed_volume(m), volume, 0.02 * volume);
  }
}

TEST(FillHoles, RimsThatAreNotFlatGetTheSmallestSurface) {
  Mesh m = refine(box({0, 0, 0}, {1, 1, 1}), 3);
  // Cut a corner off: the rim lies in three planes.
  std::erase_if(m.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](auto v) { return m.vertices[v].minCoeff() > 0.7; });
  });
  weld(m, 0);
  const Mesh open = m;
  HoleLimits limits;
  limits.max_unevenness = 0;
  const auto holes = fill_holes(m, limits);
  ASSERT_EQ(holes.size(), 1u);
  EXPECT_TRUE(holes[0].filled) << holes[0].why_not;
  EXPECT_FALSE(holes[0].flat);
  EXPECT_TRUE(edge_use(m).closed());
  EXPECT_NEAR(surface_area(m), surface_area(open) + holes[0].area, 1e-12);
  EXPECT_LT(holes[0].area, 3 * 0.25 * 0.25);
}

/// A plate of `nx` x 3 unit cells with square bores in the given cells of the middle row, without its lower face.
Mesh plate_without_floor(int nx, const std::vector<int>& bores) {
  Mesh m;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x <= nx; ++x) m.vertices.emplace_back(x, y, z);
  const auto at = [&](int x, int y, int z) { return static_cast<std::uint32_t>((z * 4 + y) * (nx + 1) + x); };
  const auto solid = [&](int x, int y) {
    return x >= 0 && x < nx && y >= 0 && y < 3 && !(y == 1 && std::find(bores.begin(), bores.end(), x) != bores.end());
  };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    m.triangles.push_back({a, b, c});
    m.triangles.push_back({a, c, d});
  };
  const auto wall = [&](int x0, int y0, int x1, int y1) {  // the material is to the left
    quad(at(x0, y0, 0), at(x1, y1, 0), at(x1, y1, 1), at(x0, y0, 1));
  };
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < nx; ++x) {
      if (!solid(x, y)) continue;
      quad(at(x, y, 1), at(x + 1, y, 1), at(x + 1, y + 1, 1), at(x, y + 1, 1));
      if (!solid(x, y - 1)) wall(x, y, x + 1, y);
      if (!solid(x + 1, y)) wall(x + 1, y, x + 1, y + 1);
      if (!solid(x, y + 1)) wall(x + 1, y + 1, x, y + 1);
      if (!solid(x - 1, y)) wall(x, y + 1, x, y);
    }
  return m;
}

TEST(FillHoles, RimsWithinAnotherAreOneHoleWithIslands) {
  // Each rim closed by a face of its own would give the same volume, and walls without thickness across the bores.
  for (const std::vector<int>& bores : {std::vector<int>{}, {1}, {1, 3}, {1, 3, 5}}) {
    Mesh m = plate_without_floor(7, bores);
    const double cells = 21 - static_cast<double>(bores.size()), sides = 20 + 4 * static_cast<double>(bores.size());
    const auto holes = fill_holes(m, {0.6});
    ASSERT_EQ(holes.size(), 1u);
    EXPECT_TRUE(holes[0].filled) << holes[0].why_not;
    EXPECT_NEAR(holes[0].area, cells, 1e-12);
    EXPECT_TRUE(edge_use(m).closed());
    EXPECT_NEAR(signed_volume(m), cells, 1e-12);
    EXPECT_NEAR(surface_area(m), 2 * cells + sides, 1e-12);
  }
}

/// Bodies that have a corner of the rim in common, as the base of a stud is a corner of its plate.
TEST(FillHoles, RimsWhoseCornersBelongToOtherBodiesAreJoinedToo) {
  for (int among = 1; among < 16; ++among) {
    Mesh m = plate_without_floor(7, {1, 3});
    for (std::uint32_t corner = 0, seen = 0; corner < m.vertices.size() && seen < 4; ++corner) {
      const Vec3 at = m.vertices[corner];
      if (at.z() != 0 || at.y() != 1 || at.x() < 1 || at.x() > 4) continue;
      if ((among >> seen++ & 1) == 0) continue;
      const auto next = static_cast<std::uint32_t>(m.vertices.size());
      for (const Vec3& d : {Vec3(0.3, 0, -0.5), Vec3(0, 0.3, -0.5), Vec3(-0.2, -0.2, -0.5)})
        m.vertices.push_back(at + d);
      for (const Triangle& t : {Triangle{corner, next + 1, next}, Triangle{corner, next + 2, next + 1},
                                Triangle{corner, next, next + 2}, Triangle{next, next + 1, next + 2}})
        m.triangles.push_back({t[0], t[2], t[1]});
    }
    const auto holes = fill_holes(m, {0.6});
    ASSERT_EQ(holes.size(), 1u) << among;
    EXPECT_NEAR(holes[0].area, 19, 1e-12);
    EXPECT_TRUE(edge_use(m).closed());
  }
}

TEST(FillHoles, ATurnedPartGetsTheSameTriangles) {
  const Mesh open = plate_without_floor(7, {1, 3, 5});
  Mesh plain = open;
  fill_holes(plain, {0.6});
  Rng rng(3);
  for (int round = 0; round < 30; ++round) {
    Mesh turned = moved(open, random_pose(rng, 5));
    fill_holes(turned, {0.6});
    EXPECT_EQ(turned.triangles, plain.triangles) << round;
  }
}

TEST(FillHoles, RimsOfDifferentSurfacesAreClosedByThemselves) {
  Mesh m = plate_without_floor(7, {});
  append(m, moved(plate_without_floor(3, {}), Pose{{5, 1, 0}, Eigen::Quaterniond(0, 0, 1, 0)}));
  EXPECT_EQ(fill_holes(m, {0.6}).size(), 2u);
  EXPECT_TRUE(edge_use(m).closed());
}

/// A vertex that lies a little off an edge, where the next face folds back: filled with a sliver, the hole would be a
/// fin without thickness, a wall that nothing may touch.
TEST(FillHoles, SlitsBesideTheSurfaceAreNoFins) {
  Rng rng(19);
  for (int round = 0; round < 60; ++round) {
    // The upper rim of the side x = 1 has vertices more than its side; they stand out by a little.
    const double out = std::pow(10, rng.uniform(-8, -3.1));
    const int more = 1 + static_cast<int>(rng.below(3));
    Mesh m = box({0, 0, 0}, {1, 1, 1});
    const auto corner = [&](double x, double y, double z) {
      for (std::uint32_t v = 0; v < m.vertices.size(); ++v)
        if (m.vertices[v] == Vec3(x, y, z)) return v;
      return geometry::kNoIndex;
    };
    const std::uint32_t a = corner(1, 0, 1), b = corner(1, 1, 1);
    const auto top = std::find_if(m.triangles.begin(), m.triangles.end(), [&](const Triangle& t) {
      return std::all_of(t.begin(), t.end(), [&](auto v) { return m.vertices[v].z() == 1; }) &&
             std::count(t.begin(), t.end(), a) + std::count(t.begin(), t.end(), b) == 2;
    });
    ASSERT_NE(top, m.triangles.end());
    const std::uint32_t apex = (*top)[0] + (*top)[1] + (*top)[2] - a - b;
    m.triangles.erase(top);
    std::uint32_t from = a;  // the upper face is on the left of its edge from a to b
    for (int k = 1; k <= more + 1; ++k) {
      std::uint32_t to = b;
      if (k <= more) {
        to = static_cast<std::uint32_t>(m.vertices.size());
        m.vertices.emplace_back(1 + out * rng.uniform(0.5, 1), (k - rng.uniform(0.1, 0.4)) / (more + 1), 1);
      }
      m.triangles.push_back({from, to, apex});
      from = to;
    }
    m = moved(m, random_pose(rng, 3));
    ASSERT_FALSE(edge_use(m).closed());
    const auto holes = fill_holes(m, {});
    ASSERT_EQ(holes.size(), 1u);
    EXPECT_TRUE(holes[0].slit && holes[0].filled);
    EXPECT_EQ(holes[0].edges, static_cast<std::size_t>(more) + 2);
    EXPECT_TRUE(edge_use(m).closed());
    EXPECT_NEAR(signed_volume(m), 1, out);
    for (geometry::Solid& s : geometry::split_into_solids(m)) {
      s.measure_thickness(0.1);
      for (const double t : s.thickness) EXPECT_GT(t, 0.1) << round;
    }
  }
}

TEST(FillHoles, LargeHolesStayOpen) {
  Mesh m = box({0, 0, 0}, {1, 1, 1});
  m.triangles.resize(10);
  const auto holes = fill_holes(m, {});
  ASSERT_EQ(holes.size(), 1u);
  EXPECT_FALSE(holes[0].filled);
  EXPECT_NE(holes[0].why_not.find("larger than"), std::string::npos);
  EXPECT_EQ(edge_use(m).open, 4u);
}

}  // namespace
}  // namespace dismantle
