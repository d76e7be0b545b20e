// Contact classes: all pairs of every sample have the true class and depth, at any pose of the sample.
#include "dismantle/verification/contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "dismantle/run_context.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/testing/trials.h"
#include "dismantle/verification/verifier.h"
#include "sample_checks.h"

namespace dismantle {
namespace {

constexpr double kContactTolerance = 1e-4;
constexpr double kContactNear = 0.1;  // assembly units

struct PlacedModel {
  samples::Model model;
  double scale = 1;
  Pose pose;
  std::vector<DepthBody> bodies;
};

/// In assembly units, at a random pose.
PlacedModel placed_model(samples::Model model, Rng& rng) {
  PlacedModel out;
  Aabb box;
  for (const RawPart& part : model.parts) box.extend(part.mesh.box());
  out.scale = 10 / box.size().maxCoeff();
  out.pose = shapes::random_pose(rng, 3);
  for (RawPart& part : model.parts) {
    for (auto& v : part.mesh.vertices) v = out.pose * (out.scale * (v - box.center()));
    out.bodies.emplace_back(part.mesh);
  }
  out.model = std::move(model);
  return out;
}

/// Classes of all pairs against the truth; pairs whose overlap is too shallow to tell from rounding are left out.
void expect_truth(const PlacedModel& p) {
  for (std::size_t i = 0; i < p.bodies.size(); ++i)
    for (std::size_t k = i + 1; k < p.bodies.size(); ++k) {
      const std::string &a = p.model.parts[i].name, &b = p.model.parts[k].name;
      SCOPED_TRACE(a + " and " + b);
      const auto found = classify_contact(p.bodies[i], p.bodies[k], kContactTolerance, kContactNear);
      const samples::TruthContact* truth = samples::contact_of(p.model, a, b);
      if (!truth) {
        if (found) {
          EXPECT_TRUE(found->place.contact == ContactClass::clearance || found->place.contact == ContactClass::kissing)
              << to_string(found->place.contact);
        }
        continue;
      }
      const double depth = truth->depth * p.scale;
      if (truth->contact != ContactClass::duplicate && depth < 10 * kContactTolerance) continue;
      ASSERT_TRUE(found);
      EXPECT_EQ(to_string(found->place.contact), to_string(truth->contact)) << "share " << found->place.share;
      EXPECT_NEAR(found->depth, depth, truth->depth_error * p.scale + 0.01 * depth + 2 * kContactTolerance);
      EXPECT_TRUE(found->place.share >= 0 && found->place.share <= 1);
      if (truth->contact == ContactClass::inside) {
        EXPECT_EQ(found->first_inside, truth->a == a);
      }
      if (truth->contact == ContactClass::uniform_interference) {
        ASSERT_TRUE(found->place.axis);
        EXPECT_GT(std::abs(found->place.axis->dot(p.pose.q * Eigen::Vector3d::UnitZ())), 0.999);
      }
      Aabb region = found->place.region;
      region.inflate(1e-9);
      EXPECT_TRUE(region.contains(found->place.at));
    }
}

class EverySampleContact : public ::testing::TestWithParam<std::string> {};

TEST_P(EverySampleContact, HasTheClassOfItsTruth) {
  const samples::Sample& sample = *samples::find(GetParam());
  Rng rng(41);
  for (int i = 0; i < 2; ++i) expect_truth(placed_model(samples::make_model(sample.name), rng));
  for (int i = 0; i < (sample.clean ? 1 : 12); ++i) {
    ParamSet drawn;
    samples::random_model(sample, rng, drawn);
    drawn["rotate_seed"] = std::int64_t{0};  // the axis is known before placed_model() turns it
    const PlacedModel p = placed_model(samples::make_model(sample.name, drawn), rng);
    SCOPED_TRACE(samples::text(drawn));
    expect_truth(p);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EverySampleContact, ::testing::ValuesIn(samples::sample_names()),
                         [](const auto& test) { return test.param; });

// A thread overlaps its bore on a helix, which reaches the rim at one place. The screw leaves straight past all of it,
// however the parts lie: the region of the overlap goes around the axis.
TEST(Contact, AScrewThatBitesLeavesStraightInAnyPose) {
  const samples::Sample& sample = *samples::find("plain_bore_screw");
  constexpr double kTolerance = 0.001;
  Rng rng(43);
  for (int i = 0; i < testing_support::trials(8, 100); ++i) {
    ParamSet drawn;
    if (i > 0) samples::random_model(sample, rng, drawn);
    drawn["rotate_seed"] = std::int64_t{0};
    const PlacedModel p = placed_model(samples::make_model(sample.name, drawn), rng);
    SCOPED_TRACE(samples::text(drawn));
    Assembly assembly = shapes::assembly_of({p.model.parts[0].mesh, p.model.parts[1].mesh});
    const Penetration deepest = deepest_penetration(p.bodies[0], Pose{}, p.bodies[1], Pose{}, kContactTolerance);
    assembly.overlaps = {
        {0, 1, deepest.depth, classify_overlap(p.bodies[0], p.bodies[1], deepest, kContactTolerance).place}};
    const Verifier verifier(assembly, {kTolerance});
    const auto leaves = [&](double sign) {
      const Eigen::Vector3d out = p.pose.q * Eigen::Vector3d(0, 0, sign * 20);
      return verifier.check_motion({1}, {{0, Pose{}}}, {{Pose{}}, {shapes::shift(out)}}).valid;
    };
    EXPECT_TRUE(leaves(1) || leaves(-1)) << "pose " << i;
  }
}

TEST(Contact, DepthOfRandomPressFitsIsHalfTheInterference) {
  Rng rng(42);
  for (int i = 0; i < 30; ++i) {
    const double interference = rng.uniform(0.05, 0.2);
    const PlacedModel p = placed_model(samples::make_model("pressed_pin", {{"diameter", rng.uniform(3, 40)},
                                                                           {"length", rng.uniform(10, 80)},
                                                                           {"interference", interference}}),
                                       rng);
    const auto found = classify_contact(p.bodies[0], p.bodies[1], kContactTolerance, kContactNear);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->place.contact, ContactClass::uniform_interference);
    EXPECT_NEAR(found->depth / p.scale, interference / 2, 0.005 * interference + 1.5 * kContactTolerance / p.scale);
  }
}

/// Boxes on each other: depth and share of the overlap determine the class.
TEST(Contact, BoxesByDepth) {
  Rng rng(43);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = shapes::random_pose(rng, 5);
    const double w = rng.uniform(1, 3), h = rng.uniform(1, 3), depth = rng.uniform(0.005, 0.1);
    const auto contact_of_gap = [&](double gap) {
      const DepthBody a(shapes::moved(shapes::box({-w, -w, -h}, {w, w, 0}), pose));
      const DepthBody b(shapes::moved(shapes::box({-w / 2, -w / 3, gap}, {w / 4, w / 2, h}), pose));
      return classify_contact(a, b, kContactTolerance, kContactNear);
    };
    const auto pressed = contact_of_gap(-depth), kissing = contact_of_gap(0),
               clear = contact_of_gap(0.5 * kContactNear);
    ASSERT_TRUE(pressed && kissing && clear);
    EXPECT_EQ(to_string(pressed->place.contact), to_string(ContactClass::uniform_interference)) << pressed->place.share;
    EXPECT_NEAR(pressed->depth, depth, 2 * kContactTolerance);
    EXPECT_FALSE(pressed->place.axis);
    EXPECT_EQ(to_string(kissing->place.contact), to_string(ContactClass::kissing));
    EXPECT_EQ(to_string(clear->place.contact), to_string(ContactClass::clearance));
    EXPECT_FALSE(contact_of_gap(3 * kContactNear));
  }
}

/// A ball that penetrates a plate overlaps it in a small region at the ball.
TEST(Contact, BallsOnPlatesAreLocal) {
  Rng rng(44);
  for (int i = 0; i < 20; ++i) {
    const Pose pose = shapes::random_pose(rng, 5);
    const double r = rng.uniform(0.3, 1.5), depth = rng.uniform(0.02, 0.1) * r, x = rng.uniform(-2, 2);
    const Mesh plate = shapes::box({-4, -4, -2}, {4, 4, 0}), ball = shapes::sphere({x, 1, r - depth}, r, 4);
    const auto found = classify_contact(DepthBody(shapes::moved(ball, pose)), DepthBody(shapes::moved(plate, pose)),
                                        kContactTolerance, kContactNear);
    ASSERT_TRUE(found);
    EXPECT_EQ(to_string(found->place.contact), to_string(ContactClass::local_interference)) << found->place.share;
    const double half_chord = std::sqrt(2 * r * depth);
    EXPECT_LT((found->place.region.center() - pose * Eigen::Vector3d(x, 1, 0)).norm(), half_chord);
    EXPECT_LT(found->place.region.size().norm(), 6 * half_chord);
  }
}

/// Facets of pin and hole need not match, and neither must be round: the overlap is deep enough on every side.
TEST(Contact, PressFitsOfUnequalFacetsAndOfPrismsAreUniform) {
  Rng rng(47);
  for (int i = 0; i < 30; ++i) {
    const Pose pose = shapes::random_pose(rng, 5);
    const bool prism = i % 3 == 0;
    const int around = prism ? 4 + static_cast<int>(rng.below(3)) : 16 + static_cast<int>(rng.below(80));
    const int of_hole = prism ? around : 16 + static_cast<int>(rng.below(80));
    const double r = rng.uniform(0.5, 1.5), stray = r * (1 - std::cos(std::numbers::pi / std::min(around, of_hole)));
    const double press = prism ? rng.uniform(0.02, 0.1) : std::max(rng.uniform(0.02, 0.05), 3 * stray);
    const double phase = prism ? 0 : rng.uniform(0, 1);
    const Mesh bush = shapes::tube(r, 2.5 * r, -1, 1, of_hole),
               pin = shapes::tube(0, r + press, -1.5, 1.5, around, 1, phase);
    const auto found = classify_contact(DepthBody(shapes::moved(pin, pose)), DepthBody(shapes::moved(bush, pose)),
                                        kContactTolerance, kContactNear);
    ASSERT_TRUE(found);
    EXPECT_EQ(to_string(found->place.contact), to_string(ContactClass::uniform_interference))
        << around << " in " << of_hole << ", share " << found->place.share;
    ASSERT_TRUE(found->place.axis);
    EXPECT_GT(std::abs(found->place.axis->dot(pose.q * Eigen::Vector3d::UnitZ())), 0.99);
    const Eigen::Vector3d arm = found->place.axis_point - pose.t;
    EXPECT_LT((arm - arm.dot(*found->place.axis) * *found->place.axis).norm(), 0.05 * r);
  }
}

/// A pin that penetrates only one side of its hole is no press fit.
TEST(Contact, PinsOffTheirAxisAreLocal) {
  Rng rng(45);
  for (int i = 0; i < 20; ++i) {
    const Pose pose = shapes::random_pose(rng, 5);
    const double r = rng.uniform(0.5, 1.5), play = rng.uniform(0.01, 0.03), depth = rng.uniform(0.02, 0.05);
    const double turn = rng.uniform(0, 6.28), away = play + depth;
    Pose off;
    off.t = away * Eigen::Vector3d(std::cos(turn), std::sin(turn), 0);
    const Mesh bush = shapes::tube(r, 2 * r, -1, 1, 64), pin = shapes::tube(0, r - play, -1.5, 1.5, 64);
    const auto found = classify_contact(DepthBody(shapes::moved(pin, pose * off)), DepthBody(shapes::moved(bush, pose)),
                                        kContactTolerance, kContactNear);
    ASSERT_TRUE(found);
    EXPECT_EQ(to_string(found->place.contact), to_string(ContactClass::local_interference)) << found->place.share;
    EXPECT_FALSE(found->place.axis);
  }
}

TEST(Contact, OneInTheSolidOfTheOther) {
  Rng rng(46);
  for (int i = 0; i < 6; ++i) {
    const Pose pose = shapes::random_pose(rng, 5);
    const Eigen::Vector3d at(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    const Mesh inner =
        shapes::moved(shapes::box(at - Eigen::Vector3d::Constant(0.5), at + Eigen::Vector3d::Constant(0.5)), pose);
    const Mesh solid = shapes::moved(shapes::box({-2, -2, -2}, {2, 2, 2}), pose);
    const Mesh hollow = shapes::moved(shapes::closed_box({-2, -2, -2}, {2, 2, 2}, 0.3), pose);
    const auto found = classify_contact(DepthBody(inner), DepthBody(solid), kContactTolerance, kContactNear);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->place.contact, ContactClass::inside);
    EXPECT_TRUE(found->first_inside);
    const auto turned = classify_contact(DepthBody(solid), DepthBody(inner), kContactTolerance, kContactNear);
    ASSERT_TRUE(turned);
    EXPECT_EQ(turned->place.contact, ContactClass::inside);
    EXPECT_FALSE(turned->first_inside);
    const auto in_void = classify_contact(DepthBody(inner), DepthBody(hollow), kContactTolerance, kContactNear);
    if (in_void) {
      EXPECT_NE(in_void->place.contact, ContactClass::inside);
    }
  }
}

TEST(Contact, NeedsATolerance) {
  const DepthBody a(shapes::box({0, 0, 0}, {1, 1, 1}));
  EXPECT_THROW(classify_contact(a, a, 0, kContactNear), std::invalid_argument);
  EXPECT_THROW(classify_overlap(a, a, {}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace dismantle
