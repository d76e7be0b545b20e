#include "dismantle/geometry/triangle_bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

using shapes::random_pose;
using shapes::random_vector;
using shapes::Vec3;

double box_distance(const Vec3& p, const Vec3& lo, const Vec3& hi) {
  const Vec3 out = (lo - p).cwiseMax(p - hi);
  const double outside = out.cwiseMax(0.0).norm();
  return outside > 0 ? outside : out.maxCoeff();
}

TEST(TriangleBvh, ClosestEqualsBruteForce) {
  Rng rng(1);
  const Mesh mesh = shapes::moved(shapes::tube(0.6, 1.3, -1, 2, 40, 6), random_pose(rng, 2));
  const TriangleBvh bvh(mesh);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random_vector(rng, -4, 4);
    double best = 1e9;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      best =
          std::min(best, (closest_on_triangle(p, mesh.vertex(t, 0), mesh.vertex(t, 1), mesh.vertex(t, 2)) - p).norm());
    const ClosestPoint c = bvh.closest(p);
    EXPECT_DOUBLE_EQ(c.distance, best);
    EXPECT_NEAR((c.point - p).norm(), c.distance, 1e-14);
    EXPECT_LT(c.triangle, mesh.triangles.size());
    EXPECT_EQ(bvh.closest(p, best * 0.99).triangle, 0xffffffffu);
    EXPECT_EQ(bvh.closest(p, best * 1.01).triangle, c.triangle);
  }
}

TEST(TriangleBvh, SignedDistanceOfABoxIsTheClosedForm) {
  Rng rng(2);
  const Vec3 lo(-1, -2, -0.5), hi(2, 1, 1);
  const TriangleBvh bvh(shapes::refine(shapes::box(lo, hi), 2));
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p = random_vector(rng, -3, 3);
    EXPECT_NEAR(bvh.signed_distance(p), box_distance(p, lo, hi), 1e-12);
  }
  // On the lattice of the mesh's own vertices and edges, where rays that follow the axes hit edges.
  for (double x = -1.5; x <= 2.5; x += 0.25)
    for (double y = -2.5; y <= 1.5; y += 0.25)
      for (double z = -0.75; z <= 1.25; z += 0.125) {
        const double d = box_distance({x, y, z}, lo, hi);
        if (std::abs(d) < 1e-9) continue;
        EXPECT_EQ(bvh.inside({x, y, z}), d < 0) << x << ' ' << y << ' ' << z;
      }
}

TEST(TriangleBvh, ShellsCountAsTheirUnionAndVoidsAsOutside) {
  Rng rng(3);
  Mesh mesh = shapes::closed_box({0, 0, 0}, {4, 4, 4}, 1.0);  // hollow from 1 to 3
  shapes::append(mesh, shapes::box({2, -1, -1}, {6, 2, 5}));  // overlaps wall and hollow
  shapes::append(mesh, shapes::box({10, 0, 0}, {11, 1, 1}));  // apart
  const TriangleBvh bvh(mesh);
  int inside = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p(rng.uniform(-1, 12), rng.uniform(-2, 5), rng.uniform(-2, 6));
    const bool hollow = box_distance(p, {0, 0, 0}, {4, 4, 4}) < 0 && box_distance(p, {1, 1, 1}, {3, 3, 3}) > 0;
    const bool expected =
        hollow || box_distance(p, {2, -1, -1}, {6, 2, 5}) < 0 || box_distance(p, {10, 0, 0}, {11, 1, 1}) < 0;
    EXPECT_EQ(bvh.inside(p), expected);
    inside += expected;
  }
  EXPECT_GT(inside, 500);
  EXPECT_EQ(bvh.winding_number({2.5, 1.5, 1.5}), 1);
  EXPECT_EQ(bvh.winding_number({3.5, 1.5, 1.5}), 2);
}

TEST(TriangleBvh, RaysThroughEdgesAndCornersAreCountedRight) {
  // Spheres have many vertices and edges that rays may hit.
  const TriangleBvh bvh(shapes::sphere(Vec3::Zero(), 1, 3));
  Rng rng(4);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = random_vector(rng, -1.2, 1.2);
    if (std::abs(p.norm() - 1) < 0.03) continue;
    EXPECT_EQ(bvh.winding_number(p), p.norm() < 1 ? 1 : 0);
  }
  // A fan whose common corner lies exactly on the first ray from the origin.
  const Vec3 d = Vec3(0.3716542397, 0.8410289143, 0.3930517461).normalized();
  Mesh fan;
  const Vec3 u = d.unitOrthogonal(), v = d.cross(u);
  fan.vertices = {2 * d, -2 * d};
  for (int i = 0; i < 7; ++i) fan.vertices.push_back(std::cos(i * 0.8976) * u + std::sin(i * 0.8976) * v);
  for (std::uint32_t i = 0; i < 7; ++i) {
    fan.triangles.push_back({0, 2 + i, 2 + (i + 1) % 7});
    fan.triangles.push_back({1, 2 + (i + 1) % 7, 2 + i});
  }
  const TriangleBvh spindle(fan);
  for (double s : {-1.9, -1.0, -0.5, 0.0, 0.5, 1.0, 1.9}) EXPECT_EQ(spindle.winding_number(s * d), 1) << s;
  for (double s : {-2.1, -3.0, 2.1, 3.0}) EXPECT_EQ(spindle.winding_number(s * d), 0) << s;
}

TEST(TriangleBvh, OverlappingFindsEveryTriangleOnce) {
  Rng rng(5);
  const Mesh mesh = shapes::sphere(Vec3::Zero(), 2, 3);
  const TriangleBvh bvh(mesh);
  for (int i = 0; i < 100; ++i) {
    Aabb box;
    box.extend(random_vector(rng, -2, 2));
    box.extend(random_vector(rng, -2, 2));
    std::set<std::uint32_t> found, expected;
    bvh.overlapping(box, [&](std::uint32_t t) { EXPECT_TRUE(found.insert(t).second); });
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      Aabb b;
      for (int k = 0; k < 3; ++k) b.extend(mesh.vertex(t, k));
      if (b.overlaps(box)) expected.insert(t);
    }
    EXPECT_EQ(found, expected);
  }
}

// Planes through corners and along edges included: what they divide is never left out, and little else is found.
TEST(TriangleBvh, OverlappingAPlaneFindsEveryTriangleThatItDivides) {
  Rng rng(6);
  const Mesh mesh = shapes::moved(shapes::refine(shapes::box({-1, -2, -0.5}, {2, 1, 1}), 4), random_pose(rng, 2));
  const TriangleBvh bvh(mesh);
  std::size_t met = 0, divided = 0;
  for (int i = 0; i < 200; ++i) {
    const std::size_t t = rng.below(mesh.triangles.size());
    const Vec3 point = mesh.vertex(t, 0);
    const Vec3 aside = i % 2 == 0 ? Vec3(mesh.vertex(t, 1) - point) : random_vector(rng, -1, 1);
    const Vec3 normal = aside.cross(random_vector(rng, -1, 1)).normalized();
    Aabb box;
    box.extend(point);
    box.inflate(rng.uniform(0.1, 2));
    std::set<std::uint32_t> near, found;
    bvh.overlapping(box, [&](std::uint32_t k) { near.insert(k); });
    bvh.overlapping(box, point, normal, [&](std::uint32_t k) { EXPECT_TRUE(found.insert(k).second); });
    for (const std::uint32_t k : found) EXPECT_TRUE(near.contains(k));
    for (const std::uint32_t k : near) {
      Vec3 heights;
      for (int c = 0; c < 3; ++c) heights[c] = normal.dot(mesh.vertex(k, c) - point);
      if (heights.minCoeff() > 0 || heights.maxCoeff() < 0) continue;
      EXPECT_TRUE(found.contains(k)) << "plane " << i;
      ++divided;
    }
    met += found.size();
  }
  EXPECT_GT(divided, 1000U);
  EXPECT_LT(met, 3 * divided);
}

TEST(TriangleBvh, EmptyAndSliverMeshes) {
  const TriangleBvh none{Mesh{}};
  EXPECT_EQ(none.closest(Vec3::Zero()).triangle, 0xffffffffu);
  EXPECT_FALSE(none.inside(Vec3::Zero()));
  Mesh sliver;
  sliver.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 0, 0}};
  sliver.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 3}};
  EXPECT_NEAR(TriangleBvh(sliver).closest({0.5, 2, 0}).distance, 2, 1e-15);
  EXPECT_NEAR(TriangleBvh(sliver).closest({3, 0, 0}).distance, 2, 1e-15);
}

TEST(TriangleBvh, ManyEqualCentresDoNotMakeADeepTree) {
  Mesh stack;
  for (int i = 0; i < 3000; ++i) shapes::append(stack, shapes::box(Vec3::Constant(-1 - i), Vec3::Constant(1 + i)));
  const TriangleBvh bvh(stack);
  EXPECT_EQ(bvh.winding_number(Vec3::Zero()), 3000);
  EXPECT_NEAR(bvh.closest(Vec3::Zero()).distance, 1, 1e-15);
}

TEST(TriangleBvh, InsideOfAnOpenBoxEndsWhereTheOpeningFillsHalfTheView) {
  // A cube without its top: of a point at height h on its axis, the opening takes the share that the square has.
  Mesh cup = shapes::refine(shapes::box({-1, -1, -2}, {1, 1, 0}), 3);
  std::erase_if(cup.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](auto v) { return cup.vertices[v].z() > -1e-9; });
  });
  const TriangleBvh bvh(cup, {}, Surface::open);
  for (const double h : {-1.9, -1.5, -1.0, -0.5, -0.1, -0.01}) {
    const double opening = std::asin(1 / (1 + h * h)) / std::numbers::pi;  // a square of half edge 1 at distance h
    EXPECT_NEAR(bvh.generalised_winding_number({0, 0, h}), 1 - opening, 0.01) << h;
    EXPECT_EQ(bvh.inside({0, 0, h}), opening < 0.5) << h;
  }
  EXPECT_FALSE(bvh.inside({0, 0, 0.01}));
  EXPECT_FALSE(bvh.inside({0, 0, -2.01}));
  EXPECT_FALSE(bvh.inside({9, 0, -1}));
}

TEST(TriangleBvh, GeneralisedWindingNumberCountsNestedShellsAndHoles) {
  Mesh stack;
  for (int i = 0; i < 30; ++i) shapes::append(stack, shapes::box(Vec3::Constant(-1 - i), Vec3::Constant(1 + i)));
  const Vec3 inside(0.1, 0.2, 0.3), between(4.5, 0.2, 0.3);
  const TriangleBvh bvh(stack, {}, Surface::open);
  EXPECT_NEAR(bvh.generalised_winding_number(inside), 30, 0.01);
  EXPECT_NEAR(bvh.generalised_winding_number(between), 26, 0.01);
  for (Triangle& t : stack.triangles) std::swap(t[0], t[1]);
  const TriangleBvh turned(stack, {}, Surface::open);
  EXPECT_NEAR(turned.generalised_winding_number(inside), -30, 0.01);
  EXPECT_NEAR(turned.generalised_winding_number(between), -26, 0.01);
}

TEST(TriangleBvh, GeneralisedWindingNumberEqualsTheSumOfSolidAngles) {
  Rng rng(77);
  Mesh soup;
  for (int t = 0; t < 400; ++t) {
    const Vec3 at = random_vector(rng, -2, 2);
    const auto n = static_cast<std::uint32_t>(soup.vertices.size());
    for (int k = 0; k < 3; ++k) soup.vertices.push_back(at + random_vector(rng, -0.3, 0.3));
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  const TriangleBvh bvh(soup, {}, Surface::open);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = random_vector(rng, -3, 3);
    double sum = 0;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
      const Vec3 a = (soup.vertex(t, 0) - p).normalized(), b = (soup.vertex(t, 1) - p).normalized(),
                 c = (soup.vertex(t, 2) - p).normalized();
      sum += 2 * std::atan2(a.dot(b.cross(c)), 1 + a.dot(b) + b.dot(c) + c.dot(a));
    }
    EXPECT_NEAR(bvh.generalised_winding_number(p), sum / (4 * std::numbers::pi), 0.01);
  }
}

}  // namespace
}  // namespace dismantle
