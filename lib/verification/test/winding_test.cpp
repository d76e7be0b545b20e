// Many turns of one screw motion, given by many poses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dismantle/testing/shapes.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {
namespace {

using shapes::assembly_of;
using shapes::random_pose;
using shapes::random_vector;
using shapes::Vec3;

struct Screw {
  Vec3 origin, axis;
  double pitch;  // way per rad

  Pose at(double angle) const {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, axis));
    return {origin - q * origin + angle * pitch * axis, q};
  }
};

Path winding(const Screw& screw, const Pose& start, double angle, int poses) {
  Path path;
  for (int k = 0; k <= poses; ++k) path.push_back({screw.at(angle * k / poses) * start});
  return path;
}

MotionCheck check(const Verifier& verifier, PartId moving, PartId fixed, const Path& path) {
  return verifier.check_motion({moving}, {{fixed, Pose{}}}, path);
}

Mesh random_box(Rng& rng, const Vec3& at) {
  const Vec3 half = random_vector(rng, 0.05, 0.4);
  return shapes::moved(shapes::box(-half, half), {at, random_pose(rng, 0).q});
}

TEST(Winding, AgreesWithDenseSamplingHoweverItWinds) {
  Rng rng(5);
  int accepted = 0, refused = 0, clear = 0;
  for (int i = 0; i < 40; ++i) {
    const Screw screw{random_vector(rng, -3, 3), random_vector(rng, -1, 1).normalized(),
                      (i % 2 == 0 ? 1 : -1) * rng.uniform(0.02, 0.4)};
    const Vec3 out = screw.axis.unitOrthogonal();
    // One on the axis, one beside, one far from it.
    const double radius = (i % 3) * rng.uniform(0.6, 1.2), angle = rng.uniform(2, 14);
    const Mesh part = random_box(rng, screw.origin + radius * out);
    Mesh others;
    for (int k = 0; k < 5; ++k) {
      const Vec3 around = Eigen::AngleAxisd(rng.uniform(-4, 4), screw.axis) * out;
      shapes::append(others, random_box(rng, screw.origin + rng.uniform(0.3, 2.5) * around +
                                                 rng.uniform(-0.5, 1.2) * angle * screw.pitch * screw.axis));
    }
    const Path path = winding(screw, Pose{}, angle, static_cast<int>(angle * rng.uniform(3, 20)));
    const Verifier verifier(assembly_of({part, others}), {0.01});
    const MotionCheck c = check(verifier, 0, 1, path);
    double deepest = 0;
    for (int k = 0; k <= 240 && deepest < 0.02; ++k)
      deepest = std::max(deepest, penetration_depth(part, screw.at(angle * k / 240), others, {}, 1e-3));
    if (deepest > 0.0101) {
      EXPECT_FALSE(c.valid) << i;
    }
    if (deepest == 0) {
      ++clear;
      EXPECT_TRUE(c.valid) << i << " " << (c.violation ? c.violation->depth : 0);
    }
    (c.valid ? accepted : refused) += 1;
    // The same motion with the other part moving.
    Path back;
    for (const auto& instant : path) back.push_back({instant[0].inverse()});
    EXPECT_EQ(check(verifier, 1, 0, back).valid, c.valid) << i;
  }
  EXPECT_GT(accepted, 8);
  EXPECT_GT(refused, 8);
  EXPECT_GT(clear, 8);
}

/// A wire of square section (`half` high and wide) at `radius` around the axis, wound `turns` times.
Mesh spring(const Screw& screw, double radius, double half, double turns) {
  Mesh mesh;
  const int steps = static_cast<int>(turns * 24);
  const Vec3 out = screw.axis.unitOrthogonal();
  for (int k = 0; k <= steps; ++k)
    for (int c = 0; c < 4; ++c) {
      const double dr = c == 1 || c == 2 ? half : -half, dz = c >= 2 ? half : -half;
      mesh.vertices.push_back(screw.at(2 * std::numbers::pi * k / 24) *
                              (screw.origin + (radius + dr) * out + dz * screw.axis));
    }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(steps); ++k)
    for (std::uint32_t c = 0; c < 4; ++c) {
      const std::uint32_t d = (c + 1) % 4;
      quad(4 * k + c, 4 * k + d, 4 * k + 4 + d, 4 * k + 4 + c);
    }
  const auto last = static_cast<std::uint32_t>(4 * steps);
  quad(0, 3, 2, 1);
  quad(last, last + 1, last + 2, last + 3);
  return mesh;
}

constexpr double kLead = 1.25, kHalf = 0.27;  // two wires side by side leave 0.085 between them

struct Thread {
  Screw screw;
  Mesh nut, bolt;

  Thread(Rng& rng, double hand, double turns)
      : screw{random_vector(rng, -3, 3), random_vector(rng, -1, 1).normalized(), hand * kLead / (2 * std::numbers::pi)},
        nut(shapes::moved(spring(screw, 2, kHalf, 0.5), {0.5 * kLead * screw.axis, Eigen::Quaterniond::Identity()})),
        bolt(spring(screw, 2, kHalf, turns + 1)) {}
};

TEST(Winding, FollowsAThreadAndSeesWhereItIsBlockedOrHasTheWrongLead) {
  Rng rng(6);
  for (const double hand : {1.0, -1.0}) {
    const double angle = 2 * std::numbers::pi * 3;
    Thread t(rng, hand, 3);
    const auto valid = [&](const Screw& screw, double to) {
      return check(Verifier(assembly_of({t.nut, t.bolt}), {0.01}), 0, 1, winding(screw, {}, to, 200)).valid;
    };
    EXPECT_TRUE(valid(t.screw, angle));
    EXPECT_FALSE(valid({t.screw.origin, t.screw.axis, 1.05 * t.screw.pitch}, angle));
    EXPECT_FALSE(
        valid({t.screw.origin + 0.2 * t.screw.axis.unitOrthogonal(), t.screw.axis, 0.5 * t.screw.pitch}, angle));
    // An obstacle in the groove, half a radian before the final position of the nut's front end.
    const Vec3 at = t.screw.origin + 2 * t.screw.axis.unitOrthogonal() + 0.5 * kLead * t.screw.axis;
    const Vec3 half = Vec3::Constant(0.02);
    shapes::append(t.bolt,
                   shapes::moved(shapes::box(at - half, at + half), t.screw.at(angle + std::numbers::pi - 0.5)));
    EXPECT_FALSE(valid(t.screw, angle));
    EXPECT_TRUE(valid(t.screw, angle - 0.6));
  }
}

TEST(Winding, TurnsCostNextToNothing) {
  Rng rng(7);
  const auto tests = [&](double turns) {
    const Thread t(rng, 1, turns);
    const Path path = winding(t.screw, {}, 2 * std::numbers::pi * turns, static_cast<int>(100 * turns));
    const MotionCheck c = check(Verifier(assembly_of({t.nut, t.bolt}), {0.01}), 0, 1, path);
    EXPECT_TRUE(c.valid);
    return c.tests;
  };
  EXPECT_LT(tests(12), 2 * tests(3));
}

}  // namespace
}  // namespace dismantle
