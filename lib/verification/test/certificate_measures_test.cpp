// Measurements of the certificate checkers against closed forms and the queries of lib/geometry, with which they share
// no code.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "certificates/body.h"
#include "certificates/circle.h"
#include "certificates/free_bound.h"
#include "certificates/hull_depth.h"
#include "certificates/nearest.h"
#include "certificates/section.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/part_memo.h"
#include "dismantle/testing/held_shapes.h"

namespace dismantle::certificates {
namespace {

using std::numbers::pi;

Vec3 any_point(Rng& rng, double reach) {
  return reach * Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
}

/// The only body of a mesh.
Body body_of(const Mesh& mesh) {
  const Assembly assembly = shapes::assembly_of({mesh});
  PartMemo memo;
  const SeparationQuery query{assembly, {}, {}, 0.01, 1, memo};
  const auto& bodies = bodies_of(query, 0);
  EXPECT_EQ(bodies.size(), 1U);
  return bodies.front();
}

TEST(CertificateMeasures, DistancesAndInsideAgreeWithTheHierarchy) {
  Rng rng(1);
  for (int i = 0; i < 20; ++i) {
    const Mesh mesh = shapes::moved(i % 2 == 0 ? shapes::can(1, 0.6, 0.3, 0.5) : shapes::sphere({0, 0, 0}, 1, 2),
                                    shapes::random_pose(rng, 1));
    const Body body = body_of(mesh);
    const TriangleBvh hierarchy(mesh);
    EXPECT_TRUE(body.closed);
    for (int k = 0; k < 100; ++k) {
      const Vec3 p = any_point(rng, 2.5);
      const double there = hierarchy.closest(p).distance;
      EXPECT_NEAR(distance(p, body), there, 1e-12);
      EXPECT_EQ(inside(p, body), hierarchy.inside(p));
      EXPECT_NEAR(depth(p, body), hierarchy.inside(p) ? there : 0, 1e-12);
    }
  }
}

TEST(CertificateMeasures, ASurfaceWithAHoleIsNotClosed) {
  Mesh mesh = shapes::box({0, 0, 0}, {1, 1, 1});
  EXPECT_TRUE(body_of(mesh).closed);
  mesh.triangles.pop_back();
  EXPECT_FALSE(body_of(mesh).closed);
}

TEST(CertificateMeasures, TrianglesThatAreKeptHoldTheNearestOneOfEveryPointInTheBall) {
  Rng rng(2);
  const Body a = body_of(shapes::can(1, 0.6, 0.3, 0.5)), b = body_of(shapes::box({1, 1, 1}, {2, 2, 2}));
  NearestTriangles walls;
  walls.add(a, shapes::random_pose(rng, 1), 0.2);
  walls.add(b, shapes::random_pose(rng, 1), 0.5);
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = any_point(rng, 2);
    const double radius = rng.uniform(0.01, 0.5);
    NearestTriangles::List kept;
    EXPECT_EQ(walls.clearance(p, walls.all(), radius, kept), walls.clearance(p, walls.all()));
    for (int k = 0; k < 20; ++k) {
      const Vec3 q = p + rng.uniform() * radius * any_point(rng, 1).normalized();
      EXPECT_EQ(walls.clearance(q, kept), walls.clearance(q, walls.all()));
    }
  }
}

TEST(CertificateMeasures, ABallIsInTheHullOfABoxAsFarAsItsNearestFace) {
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 half(rng.uniform(0.5, 2), rng.uniform(0.5, 2), rng.uniform(0.5, 2));
    const Pose at = shapes::random_pose(rng, 3);
    const Mesh box = shapes::moved(shapes::box(-half, half), at);
    const Vec3 p = any_point(rng, 2.2);
    const double depth = (half - p.cwiseAbs()).minCoeff();
    EXPECT_FALSE(ball_in_hull(at * p, std::max(0.0, depth) + 1e-9, box.vertices));
    if (depth > 0.02 * (p.norm() + half.norm())) {  // of the furthest corner: more than the checker resolves
      EXPECT_TRUE(ball_in_hull(at * p, 0.5 * depth, box.vertices)) << depth;
    }
  }
}

TEST(CertificateMeasures, NoFreePointOfABoxIsBelowItsBound) {
  Rng rng(4);
  int useful = 0;
  for (int i = 0; i < 200; ++i) {
    const Mesh mesh = shapes::moved(shapes::can(1, 0.6, 0.3, 0.5), shapes::random_pose(rng, 1));
    const Body body = body_of(mesh);
    const FreeBound bound(body);
    const Vec3 center =
        bound.frame().conjugate() * body.vertices[rng.below(body.vertices.size())] + any_point(rng, 0.1);
    const Vec3 half(rng.uniform(0.01, 0.3), rng.uniform(0.01, 0.3), rng.uniform(0.01, 0.3));
    const Vec3 direction = any_point(rng, 1).normalized();
    const double least = bound.least(center, half, direction);
    useful += least > direction.dot(center) - direction.cwiseAbs().dot(half) + 1e-3 ? 1 : 0;
    for (int k = 0; k < 50; ++k) {
      const Vec3 p = center + half.cwiseProduct(any_point(rng, 1));
      if (!inside(bound.frame() * p, body)) {
        EXPECT_GE(direction.dot(p), least);
      }
    }
  }
  EXPECT_GT(useful, 20);
}

TEST(CertificateMeasures, ACircleInATubeIsAsDeepAsItsWallAllows) {
  Rng rng(5);
  for (int i = 0; i < 20; ++i) {
    const Pose at = shapes::random_pose(rng, 2);
    const Body body = body_of(shapes::moved(shapes::tube(0.5, 1, -0.2, 0.2, 96), at));
    const double radius = rng.uniform(0.55, 0.95), height = rng.uniform(-0.15, 0.15);
    const Circle circle{at * Vec3(0, 0, height), at.q * Vec3::UnitZ(), radius};
    const double least = 0.98 * std::min({radius - 0.5, std::cos(pi / 96) - radius, 0.2 - std::abs(height)});
    EXPECT_TRUE(lies_deep(circle, body, least)) << radius << " " << height;
    EXPECT_FALSE(lies_deep(circle, body, 1.05 * least + 1e-3)) << radius << " " << height;
    EXPECT_FALSE(lies_deep(Circle{circle.center, at.q * Vec3::UnitX(), radius}, body, 0));
    EXPECT_TRUE(lies_deep(circle.point(1), circle.point(1.05), body, 0.5 * least));
    EXPECT_FALSE(lies_deep(circle.point(0), circle.point(pi), body, 0));
  }
}

TEST(CertificateMeasures, ASectionOfATubeIsTwoCurvesAroundItsAxis) {
  Rng rng(6);
  for (int i = 0; i < 20; ++i) {
    const Pose at = shapes::random_pose(rng, 2);
    const Body body = body_of(shapes::moved(shapes::tube(0.5, 1, -0.2, 0.2, 48), at));
    const Vec3 axis = at.q * Vec3::UnitZ();
    const double height = rng.uniform(-0.19, 0.19);
    const Plane plane{axis, axis.dot(at * Vec3(0, 0, height))};
    auto loops = section(body, neighbours_of(body), plane);
    ASSERT_EQ(loops.size(), 2U);
    std::sort(loops.begin(), loops.end(), [](const Loop& a, const Loop& b) { return a.diameter() < b.diameter(); });
    EXPECT_NEAR(loops[0].diameter(), 1, 1e-9);
    EXPECT_NEAR(loops[1].diameter(), 2, 1e-9);
    for (const Loop& loop : loops) {
      EXPECT_EQ(std::abs(loop.turns(at * Vec3(0.3, 0.1, 0), plane)), 1);
      EXPECT_EQ(loop.turns(at * Vec3(1.3, 0.1, 0), plane), 0);
    }
    EXPECT_NE(loops[0].turns(at.t, plane), loops[1].turns(at.t, plane)) << "one goes around the other way";
  }
}

}  // namespace
}  // namespace dismantle::certificates
