// A flat piece counts as caged only in a chamber whose openings its disc cannot pass in any orientation.
#include "disc/disc_cage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "disc/disc.h"
#include "disc/facets.h"
#include "dismantle/testing/held_shapes.h"
#include "dismantle/testing/trials.h"
#include "prover_rig.h"

namespace dismantle {
namespace {

using shapes::append;
using shapes::box;
using shapes::moved;
using shapes::Vec3;
using std::numbers::pi;

constexpr double kDepth = 0.01;

Pose turned(const Vec3& axis, double angle, const Vec3& about = Vec3::Zero()) {
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, axis));
  return {about - q * about, q};
}

/// A tray about the origin with a cavity of those half extents, open above.
Mesh tray(const Vec3& half, double wall) {
  const Vec3 out = half.array() + wall;
  Mesh m = box(-out, {out.x(), out.y(), -half.z()});
  for (const double s : {-1.0, 1.0}) {
    const auto add = [&](const Vec3& a, const Vec3& b) { append(m, box(a.cwiseMin(b), a.cwiseMax(b))); };
    add({s * half.x(), -out.y(), -out.z()}, {s * out.x(), out.y(), out.z()});
    add({-out.x(), s * half.y(), -out.z()}, {out.x(), s * out.y(), out.z()});
  }
  return m;
}

/// A lid at a height, with a window of those half widths; it overlaps the walls.
Mesh lid(double height, double thick, double x, double y, double reach) {
  Mesh m;
  for (const double s : {-1.0, 1.0}) {
    const auto add = [&](const Vec3& a, const Vec3& b) { append(m, box(a.cwiseMin(b), a.cwiseMax(b))); };
    add({s * x, -reach, height}, {s * reach, reach, height + thick});
    add({-x, s * y, height}, {x, s * reach, height + thick});
  }
  return m;
}

/// A tray 2.2 x 2.2 wide with a lid that is turned about z, then about x.
Mesh chamber(double x, double y, double about_z, double about_x) {
  Mesh m = tray({1.1, 1.1, 0.8}, 0.3);
  Mesh top = moved(lid(0.4, 0.2, x, y, 1.9), turned(Vec3::UnitZ(), about_z));
  append(m, moved(top, turned(Vec3::UnitX(), about_x, {0, 0, 0.4})));
  return m;
}

std::optional<immobility::DiscCage> cage_of(const Mesh& plate, const Mesh& around, const RunContext& context = {}) {
  const auto bodies = immobility::split_into_solids(plate);
  const auto discs = immobility::discs_in(bodies.at(0), immobility::medial_balls(bodies.at(0), kDepth, {}), kDepth, 1);
  if (discs.empty()) return std::nullopt;
  return immobility::disc_cage(discs[0], immobility::split_into_solids(around), 1e-4 * kDepth, {}, context);
}

/// Lies on the floor of the tray; its disc has a radius of 0.95 or a little more.
Mesh plate() { return box({-1, -1, -0.7}, {1, 1, -0.6}); }

TEST(DiscCaged, BehindAWindowShorterThanItsDiameterInEveryDirection) {
  Rng rng(1);
  for (int i = 0; i < testing_support::trials(3, 12); ++i) {
    const double x = rng.uniform(0.2, 0.65), y = rng.uniform(0.2, 0.6), about_z = i < 2 ? 0 : rng.uniform(0, pi);
    const Pose pose = shapes::random_pose(rng, 2);
    const auto cage = cage_of(moved(plate(), pose), moved(chamber(x, y, about_z, 0), pose));
    ASSERT_TRUE(cage) << x << " x " << y << " turned by " << about_z;
    EXPECT_GT(cage->disc.radius, 0.9);
  }
}

TEST(DiscCaged, BehindAWindowInALidThatSlopes) {
  Rng rng(2);
  for (int i = 0; i < testing_support::trials(2, 6); ++i) {
    const double x = rng.uniform(0.3, 0.6), y = rng.uniform(0.3, 0.6);
    EXPECT_TRUE(cage_of(plate(), chamber(x, y, rng.uniform(0, pi), rng.uniform(0.1, 0.3)))) << x << " x " << y;
  }
}

TEST(DiscCaged, NotWhereItGoesThroughOnEdge) {
  Rng rng(3);
  for (int i = 0; i < testing_support::trials(2, 8); ++i) {
    const double x = rng.uniform(1.0, 1.09), y = rng.uniform(0.15, 0.3);  // a slot, twice as wide as the plate is thick
    EXPECT_FALSE(cage_of(plate(), chamber(x, y, 0, 0))) << x << " x " << y;
    const double edge = rng.uniform(0.75, 0.9);  // a square with a longer diagonal
    EXPECT_FALSE(cage_of(plate(), chamber(edge, edge, rng.uniform(0, pi), i % 2 == 0 ? 0 : 0.15))) << edge;
  }
}

TEST(DiscCaged, NotWithoutALidOrBesideTheChamber) {
  EXPECT_FALSE(cage_of(plate(), tray({1.1, 1.1, 0.8}, 0.3)));
  const Mesh closed = chamber(0.5, 0.5, 0, 0);
  EXPECT_TRUE(cage_of(plate(), closed));
  EXPECT_FALSE(cage_of(moved(plate(), shapes::shift({0, 0, 3})), closed));
}

TEST(DiscCaged, NotWhereTheFlatPieceIsNoThickerThanWhatIsAllowed) {
  EXPECT_FALSE(cage_of(box({-1, -1, -0.7}, {1, 1, -0.7 + 1.9 * kDepth}), chamber(0.5, 0.5, 0, 0)));
}

TEST(DiscCaged, EndsWhenToldTo) {
  RunContext context;
  context.cancel.cancel();
  EXPECT_FALSE(cage_of(plate(), chamber(0.5, 0.5, 0, 0), context));
}

TEST(DiscCaged, InARoundChamberWithRoundOpenings) {
  const Mesh disc = shapes::tube(0, 0.9, -0.05, 0.05, 48);
  EXPECT_TRUE(cage_of(disc, shapes::can(1, 0.6, 0.3, 0.7)));
  EXPECT_FALSE(cage_of(disc, shapes::can(1, 0.6, 0.3, 0.92)));
  EXPECT_FALSE(cage_of(disc, shapes::can_with_window(1, 0.6, 0.3, 0.3, 24)));
}

TEST(Disc, TheSmallerPartOfAPairInACanWithAWindowThatItDoesNotPass) {
  Rng rng(9);
  const Mesh disc = shapes::tube(0, 0.9, -0.05, 0.05, 48);
  for (const std::uint32_t sectors : {6u, 24u}) {  // of 48: a chord of 0.77, and as wide as the can
    const auto cage = immobility::prove_pair(immobility::Disc{}, "disc", disc,
                                             shapes::can_with_window(1, 0.6, 0.3, 0.3, sectors), kDepth, rng);
    ASSERT_EQ(cage.has_value(), sectors == 6) << sectors;
    if (!cage) continue;
    EXPECT_EQ(cage->parts, (std::vector<PartId>{0, 1}));
    EXPECT_GT(cage->numbers.at("diameter").front(), 1.6);
    EXPECT_LT(cage->numbers.at("diameter").front(), 1.8);
  }
}

TEST(Facets, CoverWhatTheSurfaceDoes) {
  const Mesh cube = shapes::refine(box({-1, -1, -1}, {1, 1, 1}), 2);
  const immobility::Facets facets(immobility::split_into_solids(cube), 1e-6);
  EXPECT_EQ(facets.planes().size(), 6u);
  double area = 0;
  for (const auto& p : facets.planes()) area += p.area;
  EXPECT_NEAR(area, 24, 1e-9);
  for (std::uint32_t k = 0; k < 6; ++k) {
    const auto at = [&](double x, double y) { return Eigen::Vector2d(x, y); };
    EXPECT_TRUE(facets.covers(k, {at(-0.5, -0.5), at(0.5, -0.4), at(0.6, 0.7), at(-0.6, 0.5)}, 1e-6));
    EXPECT_FALSE(facets.covers(k, {at(-1.5, 0), at(1.5, 0), at(0, 1.5)}, 1e-6));
  }
}

}  // namespace
}  // namespace dismantle
