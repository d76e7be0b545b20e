#include "dismantle/geometry/hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

using shapes::random_pose;
using shapes::random_vector;
using shapes::Vec3;

std::vector<Vec3> cloud(Rng& rng, int n) {
  std::vector<Vec3> p;
  for (int i = 0; i < n; ++i) p.push_back(random_vector(rng, -1, 1));
  return p;
}

TEST(Hull, CornersOfABoxFullOfPoints) {
  Rng rng(1);
  std::vector<Vec3> points = cloud(rng, 500);
  const Mesh box = shapes::box(Vec3::Constant(-1), Vec3::Constant(1));
  points.insert(points.begin() + 250, box.vertices.begin(), box.vertices.end());
  EXPECT_EQ(hull_corners(points), box.vertices);  // in the order given
}

TEST(Hull, CornersReachAsFarAsAllPoints) {
  Rng rng(2);
  for (int i = 0; i < 50; ++i) {
    const std::vector<Vec3> points = cloud(rng, 5 + static_cast<int>(rng.below(300)));
    const std::vector<Vec3> corners = hull_corners(points);
    EXPECT_LE(corners.size(), points.size());
    for (int k = 0; k < 20; ++k) {
      const Vec3 n = random_vector(rng, -1, 1).normalized();
      double all = -10, few = -10;
      for (const auto& p : points) all = std::max(all, n.dot(p));
      for (const auto& p : corners) few = std::max(few, n.dot(p));
      EXPECT_NEAR(all, few, 1e-12);
    }
  }
}

TEST(Hull, FlatAndTinySetsComeBackWithoutDuplicates) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0), e(0.5, 0.25, 0);
  EXPECT_EQ(hull_corners(std::vector<Vec3>{}).size(), 0u);
  EXPECT_EQ(hull_corners(std::vector<Vec3>{a, a, a}).size(), 1u);
  EXPECT_EQ(hull_corners(std::vector<Vec3>{a, b, a, b}), (std::vector<Vec3>{a, b}));
  const auto flat = hull_corners(std::vector<Vec3>{a, b, c, d, e, a});
  for (const auto& p : {a, b, c, d}) EXPECT_NE(std::find(flat.begin(), flat.end(), p), flat.end());
  std::vector<Vec3> line;
  for (int i = 0; i < 20; ++i) line.emplace_back(0.1 * i, 0.2 * i, -0.3 * i);
  EXPECT_GE(hull_corners(line).size(), 2u);
}

TEST(Separate, GapOfBoxesIsTheKnownOne) {
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    const Pose world = random_pose(rng, 3);
    const double gap = rng.uniform(1e-6, 2);
    const Mesh a = shapes::moved(shapes::box({-1, -1, -1}, {0, 1, 1}), world);
    const Mesh b = shapes::moved(shapes::box({gap, -2, -0.5}, {gap + 1, 1.5, 3}), world);
    const auto s = separate(a.vertices, b.vertices);
    ASSERT_TRUE(s.has_value());
    EXPECT_NEAR(s->gap, gap, 1e-8);
    EXPECT_LT((s->normal - world.q * Vec3::UnitX()).norm(), 1e-3);
    EXPECT_FALSE(separate(a.vertices, b.vertices, gap * 1.001).has_value());
  }
}

TEST(Separate, WhatItClaimsHoldsForEveryPointAndOverlapIsNeverApart) {
  Rng rng(4);
  int apart = 0;
  for (int i = 0; i < 500; ++i) {
    std::vector<Vec3> a = cloud(rng, 1 + static_cast<int>(rng.below(40))),
                      b = cloud(rng, 1 + static_cast<int>(rng.below(40)));
    const Vec3 t = random_vector(rng, -2, 2);
    for (auto& p : b) p += t;
    const auto s = separate(a, b);
    if (s) {
      ++apart;
      double top = -1e9, bottom = 1e9;
      for (const auto& p : a) top = std::max(top, s->normal.dot(p));
      for (const auto& p : b) bottom = std::min(bottom, s->normal.dot(p));
      EXPECT_GT(bottom - top, 0);
      EXPECT_NEAR(bottom - top, s->gap, 1e-12);
      EXPECT_NEAR(s->normal.norm(), 1, 1e-12);
    }
    b.push_back(a[0]);  // a common point
    EXPECT_FALSE(separate(a, b).has_value());
  }
  EXPECT_GT(apart, 100);
}

/// The work of qhull grows with the square of the corners in one plane, so it is stopped; nothing may be lost by that.
TEST(Hull, OfVeryManyCornersItIsASuperset) {
  Rng rng(7);
  std::vector<Vec3> points;
  for (int i = 0; i < 6000; ++i)
    for (const double z : {0.0, 1.0}) {
      const double angle = 2 * std::numbers::pi * i / 6000;
      points.emplace_back(10 * std::cos(angle), 10 * std::sin(angle), z);
      points.emplace_back(rng.uniform(-7, 7), rng.uniform(-7, 7), rng.uniform(0.1, 0.9));
    }
  const std::vector<Vec3> corners = hull_corners(points);
  EXPECT_LT(corners.size(), 12'500u) << "nearly all points within are left out";
  for (int i = 0; i < 500; ++i) {
    const Vec3 d = random_vector(rng, -1, 1).normalized();
    double all = -1e9, kept = -1e9;
    for (const Vec3& p : points) all = std::max(all, d.dot(p));
    for (const Vec3& p : corners) kept = std::max(kept, d.dot(p));
    EXPECT_NEAR(all, kept, 1e-12);
  }
}

TEST(Separate, TouchingHullsAreNotApart) {
  const Mesh a = shapes::box({0, 0, 0}, {1, 1, 1});
  EXPECT_FALSE(separate(a.vertices, shapes::box({1, 0, 0}, {2, 1, 1}).vertices).has_value());        // face
  EXPECT_FALSE(separate(a.vertices, shapes::box({1, 1, 0}, {2, 2, 1}).vertices).has_value());        // edge
  EXPECT_FALSE(separate(a.vertices, shapes::box({1, 1, 1}, {2, 2, 2}).vertices).has_value());        // corner
  EXPECT_FALSE(separate(a.vertices, shapes::box({.2, .2, .2}, {.4, .4, .4}).vertices).has_value());  // within
  EXPECT_TRUE(separate(a.vertices, shapes::box({1 + 1e-9, 0, 0}, {2, 1, 1}).vertices).has_value());
}

}  // namespace
}  // namespace dismantle
