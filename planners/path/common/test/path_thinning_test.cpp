// The instants kept by thinning reproduce the whole path.
#include "dismantle/path/path_thinning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dismantle::path {
namespace {

using Eigen::Vector3d;

Vector3d random_vector(Rng& rng) { return {rng.normal(), rng.normal(), rng.normal()}; }

bool same(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i].t != b[i].t || a[i].q.coeffs() != b[i].q.coeffs()) return false;
  return a.size() == b.size();
}

/// Largest distance of sampled points of the balls between two instants.
double apart(const std::vector<Pose>& a, const std::vector<Pose>& b, const std::vector<Ball>& bodies) {
  double largest = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        const Vector3d p = bodies[i].center + sign * bodies[i].radius * Vector3d::Unit(axis);
        largest = std::max(largest, (a[i] * p - b[i] * p).norm());
      }
  return largest;
}

std::vector<Pose> between(const std::vector<Pose>& a, const std::vector<Pose>& b, double u) {
  std::vector<Pose> result;
  for (std::size_t i = 0; i < a.size(); ++i) result.push_back(screw_interpolate(a[i], b[i], u));
  return result;
}

/// Least distance of `instant` from the motion that joins `a` and `b`, all bodies at the same u.
double distance_to(const std::vector<Pose>& a, const std::vector<Pose>& b, const std::vector<Pose>& instant,
                   const std::vector<Ball>& bodies) {
  const auto f = [&](double u) { return apart(between(a, b, u), instant, bodies); };
  const int pieces = 64;
  double best = f(0), at = 0;
  for (int k = 1; k <= pieces; ++k)
    if (const double d = f(static_cast<double>(k) / pieces); d < best) best = d, at = static_cast<double>(k) / pieces;
  double lo = std::max(0.0, at - 1.0 / pieces), hi = std::min(1.0, at + 1.0 / pieces);
  for (int k = 0; k < 60; ++k) {
    const double u = lo + (hi - lo) / 3, v = hi - (hi - lo) / 3;
    (f(u) < f(v) ? hi : lo) = f(u) < f(v) ? v : u;
  }
  return std::min(best, f(0.5 * (lo + hi)));
}

/// `thinned` is a subsequence with both ends, and every dropped instant lies on the motions between the kept ones.
void expect_reproduces(const Path& path, const Path& thinned, const std::vector<Ball>& bodies, double tolerance) {
  ASSERT_GE(thinned.size(), std::min<std::size_t>(2, path.size()));
  ASSERT_TRUE(same(path.front(), thinned.front()));
  ASSERT_TRUE(same(path.back(), thinned.back()));
  std::size_t kept = 0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const bool last = k + 1 == path.size();
    if (last || (kept + 1 < thinned.size() && same(path[k], thinned[kept + 1]))) {
      if (k > 0) ++kept;
      continue;
    }
    if (k == 0) continue;
    ASSERT_LT(kept + 1, thinned.size());
    ASSERT_LE(distance_to(thinned[kept], thinned[kept + 1], path[k], bodies), tolerance + 1e-9) << "instant " << k;
  }
  EXPECT_EQ(kept + 1, thinned.size()) << "nothing that was not there";
}

/// A few screws joined, each cut at uneven places.
Path random_path(Rng& rng, std::size_t bodies, double turn, double noise) {
  std::vector<Pose> at(bodies);
  Path path{at};
  const auto pieces = 1 + rng.below(4);
  for (std::uint64_t n = 0; n < pieces; ++n) {
    std::vector<Pose> to;
    for (const auto& p : at)
      to.push_back(Pose{0.5 * random_vector(rng), rotation_from_vector(turn * random_vector(rng))} * p);
    double u = 0;
    while (u < 1) {
      u = std::min(1.0, u + rng.uniform(0.005, 0.1));
      auto instant = between(at, to, u);
      for (auto& p : instant) p.t += noise * random_vector(rng);
      path.push_back(instant);
    }
    at = path.back();
  }
  return path;
}

TEST(Thin, ReproducesEveryInstantOfRandomScrews) {
  Rng rng(31);
  std::size_t before = 0, after = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const std::size_t bodies = 1 + rng.below(3);
    std::vector<Ball> balls;
    for (std::size_t i = 0; i < bodies; ++i) balls.push_back({random_vector(rng), rng.uniform(0, 2)});
    const double noise = trial % 3 == 0 ? 0.0 : 1e-3;
    const Path path = random_path(rng, bodies, trial % 2 == 0 ? 0.0 : 0.4, noise);
    for (const double tolerance : {1e-6, 1e-3, 0.02}) {
      SCOPED_TRACE(testing::Message() << "trial " << trial << ", tolerance " << tolerance);
      const Path thinned = thin(path, balls, tolerance);
      expect_reproduces(path, thinned, balls, tolerance);
      before += path.size();
      after += thinned.size();
    }
  }
  EXPECT_LT(after, before * 3 / 4);
}

TEST(Thin, OneScrewIsTwoInstants) {
  Rng rng(32);
  for (int trial = 0; trial < 50; ++trial) {
    const double turn = trial % 2 == 0 ? 0.99 * kMostTurn : rng.uniform(kMostTurn, 3.0);
    const Pose end{random_vector(rng), rotation_from_vector(turn * random_vector(rng).normalized())};
    Path path;
    for (int k = 0; k <= 40; ++k) path.push_back({screw_interpolate(Pose{}, end, k / 40.0)});
    const Path thinned = thin(path, {{random_vector(rng), 1.0}}, 1e-6);
    // As few as the limit of rotation allows, to within a factor of two.
    EXPECT_LE(thinned.size(), trial % 2 == 0 ? 2u : 2 + static_cast<std::size_t>(2 * turn / kMostTurn));
    for (std::size_t k = 1; k < thinned.size(); ++k)
      EXPECT_LE(angle_between(thinned[k - 1][0].q, thinned[k][0].q), kMostTurn + 1e-9);
  }
}

TEST(Thin, KeepsCornersAndTurningPoints) {
  const auto instant = [](double x, double y) {
    return std::vector<Pose>{{Vector3d(x, y, 0), Eigen::Quaterniond::Identity()}};
  };
  Path corner, back;
  for (int k = 0; k <= 20; ++k) corner.push_back(instant(0.05 * k, 0));
  for (int k = 1; k <= 30; ++k) corner.push_back(instant(1, 0.05 * k));
  for (int k = 0; k <= 20; ++k) back.push_back(instant(0.05 * k, 0));
  for (int k = 19; k >= 0; --k) back.push_back(instant(0.05 * k, 0));
  const std::vector<Ball> ball{{Vector3d::Zero(), 0.0}};
  const Path a = thin(corner, ball, 1e-4), b = thin(back, ball, 1e-4);
  ASSERT_EQ(a.size(), 3u);
  EXPECT_EQ(a[1][0].t, Vector3d(1, 0, 0));
  ASSERT_EQ(b.size(), 3u);
  EXPECT_EQ(b[1][0].t, Vector3d(1, 0, 0));
}

TEST(Thin, WholeTurnsStayWholeTurns) {
  // A nut: the screw between two kept instants takes the shorter rotation, so enough instants have to be kept.
  for (const double turns : {0.4, 1.0, 10.0}) {
    Path path;
    const int steps = static_cast<int>(turns * 60);
    for (int k = 0; k <= steps; ++k) {
      const double angle = 2 * std::numbers::pi * turns * k / steps;
      path.push_back({{Vector3d(0, 0, 0.1 * angle),
                       rotation_from_vector(Vector3d(0, 0, std::remainder(angle, 2 * std::numbers::pi)))}});
    }
    const std::vector<Ball> ball{{Vector3d(0.1, 0, 0), 1.0}};
    const Path thinned = thin(path, ball, 1e-4);
    expect_reproduces(path, thinned, ball, 1e-4);
    double turned = 0;
    for (std::size_t k = 1; k < thinned.size(); ++k) turned += angle_between(thinned[k - 1][0].q, thinned[k][0].q);
    EXPECT_NEAR(turned, 2 * std::numbers::pi * turns, 1e-6);
    // As few as the limit of rotation allows, to within a factor of two.
    EXPECT_LE(thinned.size(), 4 + static_cast<std::size_t>(2 * 2 * std::numbers::pi * turns / kMostTurn));
  }
}

TEST(Thin, ShortAndStandingPathsStay) {
  const std::vector<Ball> ball{{Vector3d::Zero(), 1.0}};
  EXPECT_TRUE(thin({}, ball, 1e-3).empty());
  EXPECT_EQ(thin(Path(1, {Pose{}}), ball, 1e-3).size(), 1u);
  EXPECT_EQ(thin(Path(2, {Pose{}}), ball, 1e-3).size(), 2u);
  EXPECT_EQ(thin(Path(50, {Pose{}}), ball, 1e-3).size(), 2u);
}

TEST(Thin, NoToleranceLosesNothing) {
  Rng rng(33);
  const Path path = random_path(rng, 2, 0.3, 0.01);
  const std::vector<Ball> balls(2, Ball{Vector3d::Zero(), 1.0});
  const Path thinned = thin(path, balls, 0);
  ASSERT_EQ(thinned.size(), path.size());
  for (std::size_t k = 0; k < path.size(); ++k) EXPECT_TRUE(same(path[k], thinned[k]));
}

}  // namespace
}  // namespace dismantle::path
