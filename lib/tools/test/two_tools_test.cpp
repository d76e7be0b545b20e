// Laws of two tools at once: what is found does not cut, at any point and angle; what is apart along the axis is found.
#include "dismantle/tools/two_tools.h"

#include <gtest/gtest.h>

#include <cmath>

#include "frame.h"
#include "scene.h"

namespace dismantle::tools {
namespace {

using namespace test;

bool contains(const Volume& v, const Vec3& p) {
  if (p.z() < v.low || p.z() > v.high) return false;
  const Eigen::Vector2d q = p.head<2>();
  switch (v.form) {
    case Form::tube:
      return q.norm() <= v.radius;
    case Form::box:
      return (q.array() >= v.from.array()).all() && (q.array() <= v.to.array()).all();
    case Form::obround: {
      const Eigen::Vector2d along = v.to - v.from;
      const double t = std::clamp((q - v.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      return (q - v.from - t * along).norm() <= v.radius;
    }
  }
  return false;
}

Vec3 turned(const Vec3& p, double angle) { return Eigen::AngleAxisd(angle, Vec3::UnitZ()) * p; }

/// A bolt from above and its nut below, `apart` mm from the head's top to the nut's end.
struct Bolted {
  Fastener bolt = m3(), nut = m6_nut();
  Bolted(double apart, const Pose& pose, double mm) {
    nut.travel = 0;
    nut.axis = -Vec3::UnitZ();
    nut.top = {0, 0, -apart};
    for (Fastener* f : {&bolt, &nut}) {
      f->top = pose * f->top / mm;
      f->axis = pose.q * f->axis;
      f->mm = mm;
    }
  }
};

/// An arm with a hand at its end.
Use arm(double height, double length, double hand, double swing) {
  Use use;
  use.swing = swing;
  use.depth = 2;
  use.tool = {tube(3, 0, height), box({0, -2}, {length, 2}, height - 3, height)};
  use.hand = {obround({length - 8, 0}, {length, 0}, hand, height - 30, height + 20)};
  return use;
}

TEST(TwoTools, WhatIsFoundDoesNotCut) {
  Rng rng(11);
  int found = 0, touching = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const double mm = rng.uniform(0.2, 30);
    const Bolted b(rng.uniform(4, 25), shapes::random_pose(rng, 40), mm);
    const Use turning = arm(rng.uniform(5, 20), rng.uniform(30, 80), rng.uniform(5, 25), rng.uniform(0, 1.2));
    const Use holding = arm(rng.uniform(5, 20), rng.uniform(30, 80), rng.uniform(5, 25), 0);
    const Arcs wall{{0.5, 4}};
    const Arcs* blocked = &wall;
    const auto both = room_for_both({turning, b.bolt, {&blocked, 1}}, {holding, b.nut, {}}, true);
    if (!both) continue;
    ++found;
    const Frame one(turning, b.bolt), two(holding, b.nut);
    const auto still = swept(holding, b.nut, true);
    std::vector<Volume> at_rest = turning.tool;
    at_rest.push_back(turning.hand.front());
    const double start = both->turning.start + (both->turning.start < 2 ? 2 * std::numbers::pi : 0);
    EXPECT_GE(start, 4 - 2e-9);
    EXPECT_LE(start + turning.swing, 0.5 + 2 * std::numbers::pi + 2e-9);
    for (int k = 0; k < 4000; ++k) {
      const Volume& v = still[rng.below(still.size())];
      const Vec3 own(rng.uniform(-90, 90), rng.uniform(-90, 90), rng.uniform(v.low, v.high));
      if (!contains(v, own)) continue;
      const Vec3 there = one.inward(two.outward(turned(own, both->holding.start)));
      const double angle = both->turning.start + rng.uniform(0, turning.swing),
                   lift = rng.uniform(0, b.bolt.travel + 2);
      const Vec3 back = turned(there, -angle) - Vec3(0, 0, lift);
      for (const Volume& m : at_rest) {
        EXPECT_FALSE(contains(m, back)) << trial;
        touching += back.z() > m.low && back.z() < m.high;
      }
    }
  }
  EXPECT_GT(found, 40);
  EXPECT_GT(touching, 1000);  // the hands are at the same heights, so that angles decide
}

TEST(TwoTools, ApartAlongTheAxisEachHasItsOwnPlace) {
  const Bolted b(200, Pose{}, 1);
  const Use turning = arm(10, 60, 40, 1), holding = arm(10, 60, 40, 0);
  const auto both = room_for_both({turning, b.bolt, {}}, {holding, b.nut, {}}, true);
  ASSERT_TRUE(both);
  EXPECT_EQ(both->turning.start, room_for(turning, b.bolt, {}).start);
  EXPECT_EQ(both->holding.start, room_for(holding, b.nut, {}).start);
}

TEST(TwoTools, HandsAllAroundTheAxisDoNotFit) {
  const Bolted b(8, Pose{}, 1);
  Use turning = arm(10, 60, 10, 1), holding = arm(10, 60, 10, 0);
  turning.hand = {tube(40, -20, 40)};
  EXPECT_FALSE(room_for_both({turning, b.bolt, {}}, {holding, b.nut, {}}, true));
  EXPECT_TRUE(room_for_both({turning, b.bolt, {}}, {holding, b.nut, {}}, false));
}

}  // namespace
}  // namespace dismantle::tools
