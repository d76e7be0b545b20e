/// Laws of slippage: surfaces of known freedom give their motions, wherever they lie.
#include "dismantle/push/twists.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "dismantle/run_context.h"

namespace dismantle::push {
namespace {

using Eigen::Vector3d;

struct Sampled {
  Vector3d point, normal;
};

Pose random_pose(Rng& rng) {
  const Vector3d w(rng.normal(), rng.normal(), rng.normal());
  return {Vector3d(rng.normal(), rng.normal(), rng.normal()), rotation_from_vector(2 * w)};
}

std::vector<Contact> contacts_of(Rng& rng, const Pose& pose, const std::function<Sampled(Rng&)>& surface) {
  std::vector<Contact> contacts;
  for (int i = 0; i < 300; ++i) {
    const Sampled s = surface(rng);
    Contact c;
    c.moving = 0;
    c.other = 1;
    c.point = pose * s.point;
    c.normal = pose.q * s.normal.normalized();
    contacts.push_back(c);
  }
  return contacts;
}

Sampled on_cylinder(Rng& rng) {
  const double a = rng.uniform(0, 2 * std::numbers::pi);
  const Vector3d out(std::cos(a), std::sin(a), 0);
  return {out + Vector3d(0, 0, rng.uniform(-1, 1)), out};
}

/// Flank of a thread: (r cos a, r sin a, lead a / 2 pi), leaning outwards.
Sampled on_thread(Rng& rng, double lead) {
  const double a = rng.uniform(-8, 8), r = rng.uniform(0.9, 1.1), lean = rng.below(2) == 0 ? 0.6 : -0.6;
  const Vector3d out(std::cos(a), std::sin(a), 0), around(-std::sin(a), std::cos(a), 0);
  const double rise = lead / (2 * std::numbers::pi);
  const Vector3d along = r * around + rise * Vector3d::UnitZ(), across = out + lean * Vector3d::UnitZ();
  return {r * out + Vector3d(0, 0, rise * a + lean * (r - 1)), along.cross(across) * (lean > 0 ? 1 : -1)};
}

double opening(const Contact& c, const Twist& t, const Vector3d& center) {
  return c.normal.dot(t.linear + t.angular.cross(c.point - center));
}

TEST(Slipping, WhatIsFoundSlidesAlongAllContactsAndIsNormalized) {
  Rng rng(1);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = random_pose(rng);
    const double lead = rng.uniform(0.1, 1.0), radius = rng.uniform(0.8, 3);
    const auto contacts =
        contacts_of(rng, pose, [&](Rng& r) { return i % 2 == 0 ? on_cylinder(r) : on_thread(r, lead); });
    const Vector3d center = pose * Vector3d(0.1, -0.05, 0.2);
    const auto twists = slipping(contacts, {{0, Pose{}}}, center, radius);
    ASSERT_EQ(twists.size(), i % 2 == 0 ? 2u : 1u);
    for (const Twist& t : twists) {
      EXPECT_NEAR(t.linear.norm() + radius * t.angular.norm(), 1.0, 1e-9);
      for (const Contact& c : contacts) EXPECT_NEAR(opening(c, t, center), 0.0, 1e-6);
    }
  }
}

TEST(Slipping, AThreadTellsItsAxisItsLeadAndItsHand) {
  Rng rng(2);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = random_pose(rng);
    const double lead = (i % 2 == 0 ? 1 : -1) * rng.uniform(0.1, 1.0);
    const auto twists = slipping(contacts_of(rng, pose, [&](Rng& r) { return on_thread(r, lead); }), {{0, Pose{}}},
                                 pose * Vector3d::Zero(), 1.5);
    ASSERT_EQ(twists.size(), 1u);
    const Vector3d axis = twists[0].angular.normalized();
    EXPECT_NEAR(std::abs(axis.dot(pose.q * Vector3d::UnitZ())), 1.0, 1e-6);
    EXPECT_NEAR(2 * std::numbers::pi * axis.dot(twists[0].linear) / twists[0].angular.norm(), lead, 1e-4);
  }
}

TEST(Slipping, ARoundShaftTurnsAndSlidesSeparately) {
  Rng rng(3);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = random_pose(rng);
    const auto twists = slipping(contacts_of(rng, pose, on_cylinder), {{0, Pose{}}}, pose * Vector3d(0, 0, 0.3), 1.5);
    ASSERT_EQ(twists.size(), 2u);
    EXPECT_NEAR(twists[0].linear.norm(), 0.0, 1e-6) << "a turn about the axis, without a slide";
    EXPECT_NEAR(twists[1].angular.norm(), 0.0, 1e-6);
    EXPECT_NEAR(std::abs(twists[1].linear.dot(pose.q * Vector3d::UnitZ())), 1.0, 1e-6);
  }
}

/// Part of a torus about z: only the turn about z slips.
Sampled on_torus(Rng& rng, double big) {
  const double a = rng.uniform(-1.2, 1.2), b = rng.uniform(0, 2 * std::numbers::pi);
  const Vector3d out(std::cos(a), std::sin(a), 0);
  const Vector3d normal = std::cos(b) * out + std::sin(b) * Vector3d::UnitZ();
  return {big * out + 0.4 * normal, normal};
}

TEST(Slipping, ASleeveOnACurvedTubeTurnsAboutTheMiddleOfTheCurve) {
  Rng rng(6);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = random_pose(rng);
    const double big = rng.uniform(2, 6);
    const Vector3d center = pose * Vector3d(big, 0, 0);
    const auto twists =
        slipping(contacts_of(rng, pose, [&](Rng& r) { return on_torus(r, big); }), {{0, Pose{}}}, center, 0.7 * big);
    ASSERT_EQ(twists.size(), 1u);
    const Vector3d axis = twists[0].angular.normalized();
    EXPECT_NEAR(std::abs(axis.dot(pose.q * Vector3d::UnitZ())), 1.0, 1e-6);
    const Vector3d on_axis = center + axis.cross(twists[0].linear) / twists[0].angular.norm();
    const Vector3d off = on_axis - pose.t;
    EXPECT_LT((off - axis * axis.dot(off)).norm(), 1e-4);
    EXPECT_NEAR(axis.dot(twists[0].linear), 0, 1e-6) << "no pitch";
  }
}

/// Sides of a square prism along z.
Sampled on_prism(Rng& rng) {
  const Vector3d out = (rng.below(2) == 0 ? 1.0 : -1.0) * Vector3d::Unit(static_cast<int>(rng.below(2)));
  const Vector3d beside = Vector3d::UnitZ().cross(out);
  return {out + rng.uniform(-1, 1) * beside + Vector3d(0, 0, rng.uniform(-2, 2)), out};
}

TEST(Slipping, APrismOnlySlides) {
  Rng rng(7);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = random_pose(rng);
    const auto twists = slipping(contacts_of(rng, pose, on_prism), {{0, Pose{}}}, pose * Vector3d(0.1, 0, 0.2), 1.4);
    ASSERT_EQ(twists.size(), 1u);
    EXPECT_NEAR(std::abs(twists[0].linear.dot(pose.q * Vector3d::UnitZ())), 1.0, 1e-6);
    EXPECT_NEAR(twists[0].angular.norm(), 0, 1e-6);
  }
}

TEST(Slipping, ANutThatSitsOnAPlateStillTellsItsLead) {
  Rng rng(8);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = random_pose(rng);
    const double lead = (i % 2 == 0 ? 1 : -1) * rng.uniform(0.15, 0.6);
    const auto contacts = contacts_of(rng, pose, [&](Rng& r) {
      if (r.below(2) == 0) return on_thread(r, lead);
      const double a = r.uniform(0, 2 * std::numbers::pi), d = r.uniform(1, 1.8);
      return Sampled{Vector3d(d * std::cos(a), d * std::sin(a), -1.5), Vector3d::UnitZ()};
    });
    bool found = false;
    for (const Twist& t : slipping(contacts, {{0, Pose{}}}, pose * Vector3d::Zero(), 1.5)) {
      if (t.angular.norm() < 0.1) continue;
      const Vector3d axis = t.angular.normalized();
      const double told = 2 * std::numbers::pi * axis.dot(t.linear) / t.angular.norm();
      found |= std::abs(std::abs(axis.dot(pose.q * Vector3d::UnitZ())) - 1) < 1e-6 && std::abs(told - lead) < 1e-3;
    }
    EXPECT_TRUE(found) << "lead " << lead;
  }
}

TEST(Slipping, NothingIsSaidOfFewContactsOrOfOtherMovingParts) {
  Rng rng(4);
  auto contacts = contacts_of(rng, Pose{}, on_cylinder);
  EXPECT_TRUE(slipping({contacts.begin(), contacts.begin() + 3}, {{0, Pose{}}}, Vector3d::Zero(), 1).empty());
  EXPECT_TRUE(slipping(contacts, {{0, Pose{}}, {1, Pose{}}}, Vector3d::Zero(), 1).empty());
}

TEST(Moved, IsTheFlowOfTheTwist) {
  Rng rng(5);
  for (int i = 0; i < 200; ++i) {
    const Pose start = random_pose(rng);
    const Vector3d local(rng.normal(), rng.normal(), rng.normal());
    Twist t{Vector3d(rng.normal(), rng.normal(), rng.normal()), Vector3d(rng.normal(), rng.normal(), rng.normal())};
    if (i % 4 == 0) t.angular.setZero();
    const Vector3d center = start * local;
    // Twice half of the way is all of it, since the screw is the same all along in the axes of the part.
    const double way = rng.uniform(-1, 1);
    const Pose half = moved(start, t, center, way / 2);
    const Eigen::Quaterniond turn = half.q * start.q.conjugate();
    const Pose whole = moved(half, {turn * t.linear, turn * t.angular}, half * local, way / 2);
    const Pose direct = moved(start, t, center, way);
    EXPECT_LT((whole.t - direct.t).norm(), 1e-9);
    EXPECT_LT(angle_between(whole.q, direct.q), 1e-7);
    // Its velocity at the start.
    const double h = 1e-6;
    const Pose soon = moved(start, t, center, h);
    EXPECT_LT(((soon * local - center) / h - t.linear).norm(), 1e-4);
  }
}

}  // namespace
}  // namespace dismantle::push
