// Laws of slippage: surfaces of known freedom give their motions, wherever they lie.
#include "dismantle/geometry/slippage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::geometry {
namespace {

using Eigen::Vector3d;

using Sampled = SurfaceSample;

Pose random_pose(Rng& rng) {
  const Vector3d w(rng.normal(), rng.normal(), rng.normal());
  return {Vector3d(rng.normal(), rng.normal(), rng.normal()), rotation_from_vector(2 * w)};
}

std::vector<SurfaceSample> contacts_of(Rng& rng, const Pose& pose, const std::function<Sampled(Rng&)>& surface) {
  std::vector<SurfaceSample> contacts;
  for (int i = 0; i < 300; ++i) {
    const Sampled s = surface(rng);
    contacts.push_back({pose * s.point, pose.q * s.normal.normalized()});
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

double opening(const SurfaceSample& c, const Twist& t, const Vector3d& center) {
  return c.normal.dot(t.linear + t.angular.cross(c.point - center));
}

TEST(SlippageOfContacts, WhatIsFoundSlidesAlongAllContactsAndIsNormalized) {
  Rng rng(1);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = random_pose(rng);
    const double lead = rng.uniform(0.1, 1.0), radius = rng.uniform(0.8, 3);
    const auto contacts =
        contacts_of(rng, pose, [&](Rng& r) { return i % 2 == 0 ? on_cylinder(r) : on_thread(r, lead); });
    const Vector3d center = pose * Vector3d(0.1, -0.05, 0.2);
    const auto twists = slippable_motions(contacts, center, radius);
    ASSERT_EQ(twists.size(), i % 2 == 0 ? 2u : 1u);
    for (const Twist& t : twists) {
      EXPECT_NEAR(t.linear.norm() + radius * t.angular.norm(), 1.0, 1e-9);
      for (const SurfaceSample& c : contacts) EXPECT_NEAR(opening(c, t, center), 0.0, 1e-6);
    }
  }
}

TEST(SlippageOfContacts, AThreadTellsItsAxisItsLeadAndItsHand) {
  Rng rng(2);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = random_pose(rng);
    const double lead = (i % 2 == 0 ? 1 : -1) * rng.uniform(0.1, 1.0);
    const auto twists = slippable_motions(contacts_of(rng, pose, [&](Rng& r) { return on_thread(r, lead); }),
                                          pose * Vector3d::Zero(), 1.5);
    ASSERT_EQ(twists.size(), 1u);
    const Vector3d axis = twists[0].angular.normalized();
    EXPECT_NEAR(std::abs(axis.dot(pose.q * Vector3d::UnitZ())), 1.0, 1e-6);
    EXPECT_NEAR(2 * std::numbers::pi * axis.dot(twists[0].linear) / twists[0].angular.norm(), lead, 1e-4);
  }
}

TEST(SlippageOfContacts, ARoundShaftTurnsAndSlidesSeparately) {
  Rng rng(3);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = random_pose(rng);
    const auto twists = slippable_motions(contacts_of(rng, pose, on_cylinder), pose * Vector3d(0, 0, 0.3), 1.5);
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

TEST(SlippageOfContacts, ASleeveOnACurvedTubeTurnsAboutTheMiddleOfTheCurve) {
  Rng rng(6);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = random_pose(rng);
    const double big = rng.uniform(2, 6);
    const Vector3d center = pose * Vector3d(big, 0, 0);
    const auto twists =
        slippable_motions(contacts_of(rng, pose, [&](Rng& r) { return on_torus(r, big); }), center, 0.7 * big);
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

TEST(SlippageOfContacts, APrismOnlySlides) {
  Rng rng(7);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = random_pose(rng);
    const auto twists = slippable_motions(contacts_of(rng, pose, on_prism), pose * Vector3d(0.1, 0, 0.2), 1.4);
    ASSERT_EQ(twists.size(), 1u);
    EXPECT_NEAR(std::abs(twists[0].linear.dot(pose.q * Vector3d::UnitZ())), 1.0, 1e-6);
    EXPECT_NEAR(twists[0].angular.norm(), 0, 1e-6);
  }
}

TEST(SlippageOfContacts, ANutThatSitsOnAPlateStillTellsItsLead) {
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
    for (const Twist& t : slippable_motions(contacts, pose * Vector3d::Zero(), 1.5)) {
      if (t.angular.norm() < 0.1) continue;
      const Vector3d axis = t.angular.normalized();
      const double told = 2 * std::numbers::pi * axis.dot(t.linear) / t.angular.norm();
      found |= std::abs(std::abs(axis.dot(pose.q * Vector3d::UnitZ())) - 1) < 1e-6 && std::abs(told - lead) < 1e-3;
    }
    EXPECT_TRUE(found) << "lead " << lead;
  }
}

TEST(SlippageOfContacts, WhatIsHeldOnAllSidesHasNoGuidedMotion) {
  Rng rng(8);
  for (int i = 0; i < 30; ++i) {
    const Pose pose = random_pose(rng);
    const auto held = contacts_of(rng, pose, [](Rng& r) {  // a box in a box
      Vector3d p(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1)), n = Vector3d::Zero();
      const auto k = static_cast<Eigen::Index>(r.below(3));
      n[k] = p[k] = r.below(2) == 0 ? 1 : -1;
      return Sampled{p, n};
    });
    EXPECT_TRUE(guided_motions(held, pose.t, 1).empty());
    EXPECT_FALSE(slippable_motions(held, pose.t, 1).empty()) << "the least stiff one";
    const double lead = rng.uniform(0.1, 1.0);
    const auto thread = contacts_of(rng, pose, [&](Rng& r) { return on_thread(r, lead); });
    EXPECT_EQ(guided_motions(thread, pose.t, 1).size(), 1U);
  }
}

TEST(SlippageOfContacts, NothingIsSaidOfFew) {
  Rng rng(4);
  const auto contacts = contacts_of(rng, Pose{}, on_cylinder);
  EXPECT_TRUE(slippable_motions({contacts.begin(), contacts.begin() + 3}, Vector3d::Zero(), 1).empty());
}

/// A surface that is given by two parameters in [0, 1].
Mesh surface(const std::function<Vector3d(double, double)>& at, std::uint32_t across, std::uint32_t along) {
  Mesh mesh;
  for (std::uint32_t i = 0; i <= across; ++i)
    for (std::uint32_t k = 0; k <= along; ++k)
      mesh.vertices.push_back(at(static_cast<double>(i) / across, static_cast<double>(k) / along));
  for (std::uint32_t i = 0; i < across; ++i)
    for (std::uint32_t k = 0; k < along; ++k) {
      const std::uint32_t a = i * (along + 1) + k, b = a + along + 1;
      mesh.triangles.push_back({a, b, a + 1});
      mesh.triangles.push_back({a + 1, b, b + 1});
    }
  return mesh;
}

/// A wire about the z axis; `big`: radius of its middle line.
Mesh coil(const Pose& pose, double big, double pitch, double turns) {
  const auto at = [&](double u, double v) {
    const double a = 2 * std::numbers::pi * turns * u, b = 2 * std::numbers::pi * v;
    const Vector3d out(std::cos(a), std::sin(a), 0), around(-out.y(), out.x(), 0);
    const Vector3d forward = (big * around + pitch / (2 * std::numbers::pi) * Vector3d::UnitZ()).normalized();
    const Vector3d middle = big * out + Vector3d(0, 0, pitch * turns * u);
    return pose * Vector3d(middle + 0.02 * (std::cos(b) * out + std::sin(b) * forward.cross(out)));
  };
  return surface(at, static_cast<std::uint32_t>(32 * turns), 24);
}

TEST(SlippageOfMeshes, OfACoilIsItsScrew) {
  Rng rng(2);
  for (int k = 0; k < 10; ++k) {
    const Pose pose = random_pose(rng);
    const double big = rng.uniform(0.3, 1), pitch = rng.uniform(0.2, 1), turns = 3;
    const Mesh mesh = coil(pose, big, pitch, turns);
    const Vector3d center = mesh.box().center();
    const std::vector<Twist> found = slippable_motions(mesh, center);
    ASSERT_EQ(found.size(), 1U);
    // About its axis and along it, by its pitch; points move by about 1.
    const Vector3d axis = pose.q * Vector3d::UnitZ(), angular = found[0].angular;
    EXPECT_GT(std::abs(angular.normalized().dot(axis)), 0.999);
    const Vector3d on_axis = pose * Vector3d(0, 0, 0.5 * pitch * turns);
    const Vector3d velocity = found[0].linear + angular.cross(on_axis - center);
    EXPECT_NEAR(velocity.dot(axis) / angular.dot(axis), pitch / (2 * std::numbers::pi), 0.05 * pitch);
    EXPECT_NEAR(angular.norm() * big, 1, 0.2);
  }
}

TEST(SlippageOfMeshes, OfARodIsAlongItAndAboutIt) {
  Rng rng(3);
  for (int k = 0; k < 10; ++k) {
    const Mesh rod = coil(random_pose(rng), 0, 4, 1);
    EXPECT_EQ(slippable_motions(rod, rod.box().center()).size(), 2U);
  }
}

TEST(SlippageOfMeshes, OfABoxIsNone) {
  Rng rng(4);
  for (int k = 0; k < 20; ++k) {
    const Vector3d half(rng.uniform(0.2, 1), rng.uniform(0.2, 1), rng.uniform(0.2, 1));
    Mesh box = shapes::box(-half, half);
    const Pose pose = random_pose(rng);
    for (Vector3d& v : box.vertices) v = pose * v;
    EXPECT_TRUE(slippable_motions(box, box.box().center()).empty()) << half.transpose();
  }
}

TEST(SlippageOfMeshes, OfNothingIsNone) { EXPECT_TRUE(slippable_motions(Mesh{}, Vector3d::Zero()).empty()); }

}  // namespace
}  // namespace dismantle::geometry
