#include "dismantle/statics/verdict.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "dismantle/statics/certificates.h"
#include "dismantle/statics/flips.h"
#include "dismantle/statics/holds.h"
#include "dismantle/statics/limits.h"
#include "dismantle/testing/trials.h"
#include "piles.h"

namespace dismantle::statics {
namespace {

using namespace testing;
using Vec3 = Eigen::Vector3d;

const Vec3 kX = Vec3::UnitX(), kY = Vec3::UnitY();
constexpr double kDegree = M_PI / 180;

/// Blocks on a grid, which also press each other from the sides, or boxes anywhere.
std::vector<Mesh> random_pile(std::mt19937& random) {
  const int n = 2 + static_cast<int>(random() % 7);
  return random() % 2 == 0 ? random_blocks(random, n) : random_boxes(random, n);
}

Verdict verdict_of(const Pile& pile) { return judge(pile).verdict; }

TEST(Verdict, ABlockSlidesAtTheAngleOfFriction) {
  for (const double mu : {0.1, 0.3, 0.45}) {
    const Pile pile = pile_of({ground(), box({-1, -1, 0}, {1, 1, 0.5})}, 1, mu);
    const double limit = std::atan(mu);
    EXPECT_EQ(verdict_of(tilted(pile, kY, 0.995 * limit)), Verdict::stands) << mu;
    EXPECT_EQ(verdict_of(tilted(pile, kY, 1.005 * limit)), Verdict::falls) << mu;
    EXPECT_EQ(verdict_of(tilted(pile, Vec3(1, 1, 0).normalized(), 1.005 * limit)), Verdict::falls) << mu;
  }
}

TEST(Verdict, ASlenderBlockTopplesAtDepthOverHeight) {
  const Pile pile = pile_of({ground(), box({-0.25, -1, 0}, {0.25, 1, 1})}, 1, 0.9);  // twice as high as wide
  EXPECT_EQ(verdict_of(tilted(pile, kY, 26.4 * kDegree)), Verdict::stands);
  EXPECT_EQ(verdict_of(tilted(pile, kY, 26.8 * kDegree)), Verdict::falls);
}

TEST(Verdict, BlocksOverhangByHalfOfTheHarmonicSum) {
  for (int n = 1; n <= 5; ++n)
    for (const double factor : {0.99, 1.01}) {
      std::vector<Mesh> meshes = {box({-3, -1, -1}, {0, 1, 0})};  // an edge of the ground at x = 0
      double x = 0;                                               // right end of the block below
      for (int k = 0; k < n; ++k) {
        x += factor / (2 * (n - k));
        meshes.push_back(box({x - 1, -0.5, 0.2 * k}, {x, 0.5, 0.2 * (k + 1)}));
      }
      EXPECT_EQ(verdict_of(pile_of(meshes, 1, 0.5)), factor < 1 ? Verdict::stands : Verdict::falls)
          << n << " " << factor;
    }
}

TEST(Verdict, ABlockBetweenTwoWallsIsPressedIn) {
  const Mesh left = box({-2, -1, -1}, {-1, 1, 1}), right = box({1, -1, -1}, {2, 1, 1}),
             block = box({-1, -0.5, -0.3}, {1, 0.5, 0.3});
  const Judgement found = judge(pile_of({left, right, block}, 2, 0.5));
  EXPECT_EQ(found.verdict, Verdict::pressed_in);
  EXPECT_LT(found.motion[2].v.z(), 0);  // it would slide down
  EXPECT_EQ(verdict_of(pile_of({left, right, block}, 2, 0.0)), Verdict::falls);
}

// Law: a motion straight down presses nothing, though rounding says so in some positions.
TEST(Verdict, ABlockBetweenWallsIsPressedInWhereverItIs) {
  std::mt19937 random(29);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const double half = 0.6 + unit(random), friction = 0.05 + 0.4 * unit(random),
                 scale = std::exp(6 * unit(random) - 3);
    std::vector<Mesh> meshes = {box({-2, -1, -3}, {-1, 1, 3}), box({1, -1, -3}, {2, 1, 3}),
                                box({-1, -unit(random), -half}, {1, unit(random), half})};
    const Eigen::Quaterniond turn = Eigen::Quaterniond::UnitRandom();
    for (Mesh& m : meshes)
      for (Vec3& v : m.vertices) v = scale * (turn * v);
    Pile pile = pile_of(meshes, 2, friction);
    pile.down = turn * pile.down;
    EXPECT_EQ(verdict_of(pile), Verdict::pressed_in) << trial;
  }
}

TEST(Verdict, ThePressureOnWhatIsPressedInIsNotDetermined) {
  const Mesh left = box({-2, -1, -1}, {-1, 1, 1}), right = box({1, -1, -1}, {2, 1, 1}),
             block = box({-1, -0.5, -0.3}, {1, 0.5, 0.3});
  const Pile pile = pile_of({left, right, block}, 2, 0.5);
  const Judgement found = judge(pile);
  ASSERT_EQ(check_pressed_in(pile, found.forces, found.others, found.slide), "");
  EXPECT_NE(check_pressed_in(pile, found.forces, found.forces, found.slide), "");
  ContactForces others = found.others;
  others[0][0] *= 1.01;
  EXPECT_NE(check_pressed_in(pile, found.forces, others, found.slide), "");
  Motions slide = found.slide;
  slide[2].v = -slide[2].v;
  EXPECT_NE(check_pressed_in(pile, found.forces, found.others, slide), "");
  // A block on a slope stands by friction, but its weight determines the pressure: that it was pressed in cannot be
  // claimed, whatever the forces of its corners.
  const Pile slope = tilted(pile_of({ground(), box({-1, -1, 0}, {1, 1, 0.5})}, 1, 0.5), kY, 10 * kDegree);
  const Judgement stands = judge(slope);
  ASSERT_EQ(stands.verdict, Verdict::stands);
  Motions down(2);
  down[1].v = Vec3::UnitX();
  EXPECT_EQ(check_fall(without_friction(slope), down), "");
  others = stands.forces;
  const std::vector<Vec3>& corners = slope.contacts[0].points;
  ASSERT_EQ(corners.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) others[0][k] += (k % 2 == 0 ? 0.01 : -0.01) * slope.contacts[0].normal;
  EXPECT_EQ(check_equilibrium(slope, others), "");
  EXPECT_NE(check_pressed_in(slope, stands.forces, others, down), "");
}

// Between two blocks that lie on the ground by friction: how far it can be squeezed is limited.
TEST(Verdict, ABlockBetweenTwoHeavyOnesIsPressedIn) {
  Pile pile = pile_of(
      {ground(), box({-3, -1, 0}, {-1, 1, 2}), box({1, -1, 0}, {3, 1, 2}), box({-1, -0.5, 0.5}, {1, 0.5, 1})}, 1, 0.4);
  pile.bodies[3].weight = 0.5;
  const Judgement found = judge(pile);
  EXPECT_EQ(found.verdict, Verdict::pressed_in);
  EXPECT_EQ(check_pressed_in(pile, found.forces, found.others, found.slide), "");
}

TEST(Verdict, PressureOnTheLegsLimitsTheirPush) {
  // A slab of 3 on two legs of 1, friction 0.5: a horizontal push of half of its weight moves it.
  Pile pile = pile_of(
      {ground(), box({-2, -1, 0}, {-1, 1, 1}), box({1, -1, 0}, {2, 1, 1}), box({-2, -1, 1}, {2, 1, 1.2})}, 1, 0.5);
  for (const std::size_t leg : {1u, 2u}) pile.bodies[leg].weight = 1;
  pile.bodies[3].weight = 3;
  for (const double factor : {0.995, 1.005}) {
    pile.pushes = {{3, Vec3(0, 0, 1.0), Vec3(factor * 1.5, 0, 0)}};
    EXPECT_EQ(verdict_of(pile), factor < 1 ? Verdict::stands : Verdict::falls);
  }
}

TEST(Verdict, ALadderSlidesWhenItsFrictionIsTooSmall) {
  // A thin ladder against a wall without friction: tan(angle to the ground) >= 1 / (2 mu).
  const double angle = 55 * kDegree;
  const Vec3 up(std::cos(angle), 0, std::sin(angle));
  const Mesh ladder = bent_box({0, -0.2, 0}, {0.002, 0.2, 2}, [&](const Vec3& p) -> Vec3 {
    return p.z() * up + p.x() * Vec3(std::sin(angle), 0, -std::cos(angle)) + Vec3(0, p.y(), 0.002 * std::cos(angle));
  });
  double far = 0;
  for (const Vec3& v : ladder.vertices) far = std::max(far, v.x());
  const Mesh wall = box({far, -1, -0.5}, {far + 1, 1, 3});
  const double limit = 1 / (2 * std::tan(angle));
  for (const double factor : {0.98, 1.02}) {
    Pile pile = pile_of({ground(), wall, ladder}, 2, factor * limit);
    for (Contact& c : pile.contacts)
      if (std::abs(c.normal.x()) > 0.9) c.friction = 0;
    EXPECT_EQ(verdict_of(pile), factor > 1 ? Verdict::stands : Verdict::falls);
  }
}

TEST(Verdict, ALongArchStandsAlthoughItGivesWayFar) {
  std::vector<Mesh> meshes = {box({-150, -20, -20}, {150, 40, 0})};
  constexpr int kBlocks = 399;
  for (int i = 0; i < kBlocks; ++i)
    meshes.push_back(
        bent_box({M_PI * i / kBlocks, 0, 90}, {M_PI * (i + 1) / kBlocks, 20, 110}, [](const Vec3& p) -> Vec3 {
          return {-p.z() * std::cos(p.x()), p.y(), p.z() * std::sin(p.x())};
        }));
  const Pile pile = pile_of(meshes, 1, 0.6);
  for (const double angle : {0.0, 4.0, 6.0})
    EXPECT_EQ(verdict_of(tilted(pile, kY, angle * kDegree)), Verdict::stands) << angle;
}

TEST(Verdict, AWallOfManyBricksFallsWhenItIsSteep) {
  std::vector<Mesh> meshes = {box({-1, -1, -1}, {10, 3, 0})};
  for (int row = 0; row < 20; ++row)
    for (int k = 0; k < 9; ++k) {
      const double left = k + 0.5 * (row % 2);
      meshes.push_back(box({left, 0, 0.4 * row}, {left + 1, 0.5, 0.4 * row + 0.4}));
    }
  const Pile pile = pile_of(meshes, 1, 0.6);
  EXPECT_EQ(verdict_of(pile), Verdict::stands);
  for (const double angle : {40.0, 60.0}) EXPECT_EQ(verdict_of(tilted(pile, kY, angle * kDegree)), Verdict::falls);
}

TEST(Verdict, IsTheSameForAPileThatIsTurnedScaledAndRenamed) {
  std::mt19937 random(7);
  const int trials = testing_support::trials(60, 2000);
  int standing = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const auto meshes = random_pile(random);
    const Pile pile = pile_of(meshes, 1, 0.4);
    const Verdict verdict = verdict_of(pile);
    ASSERT_NE(verdict, Verdict::uncertain);
    standing += verdict == Verdict::stands;
    const Eigen::Quaterniond turn = Eigen::Quaterniond::UnitRandom();
    std::vector<Mesh> moved = meshes;
    for (Mesh& m : moved)
      for (Vec3& v : m.vertices) v = 37 * (turn * v) + Vec3(1, 2, 3);
    std::reverse(moved.begin() + 1, moved.end());
    Pile other = pile_of(moved, 1, 0.4);
    other.down = turn * pile.down;
    EXPECT_EQ(verdict_of(other), verdict) << trial;
  }
  EXPECT_GT(standing, trials / 12);
  EXPECT_LT(standing, trials - trials / 12);
}

/// The same solid: each triangle split at a point inside of it or on an edge, shared edges at the same point.
Mesh triangulated_otherwise(const Mesh& mesh, std::mt19937& random) {
  Mesh other;
  other.vertices = mesh.vertices;
  std::uniform_real_distribution<double> share(0.2, 0.8);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> between;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [at, is_new] = between.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(other.vertices.size()));
    if (is_new) {
      const double t = share(random);
      other.vertices.push_back(t * mesh.vertices[std::min(a, b)] + (1 - t) * mesh.vertices[std::max(a, b)]);
    }
    return at->second;
  };
  for (const Triangle& t : mesh.triangles) {
    const std::uint32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    for (const Triangle& piece : {Triangle{t[0], ab, ca}, Triangle{ab, t[1], bc}, Triangle{ca, bc, t[2]}})
      other.triangles.push_back(piece);
    other.triangles.push_back({ab, bc, ca});
  }
  return other;
}

TEST(Verdict, IsTheSameForAPileThatIsTriangulatedOtherwiseAndInOtherUnits) {
  std::mt19937 random(13);
  const int trials = testing_support::trials(60, 2000);
  int standing = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<Mesh> meshes = random_pile(random);
    const Verdict verdict = verdict_of(pile_of(meshes, 1, 0.4));
    standing += verdict == Verdict::stands;
    for (Mesh& m : meshes) {
      m = triangulated_otherwise(m, random);
      for (Vec3& v : m.vertices) v *= 0.001;  // metres instead of millimetres
    }
    Pile other = pile_of(meshes, 1, 0.4);
    for (Body& b : other.bodies) b.weight *= 7.85e9;  // and of another material
    EXPECT_EQ(verdict_of(other), verdict) << trial;
  }
  EXPECT_GT(standing, trials / 12);
  EXPECT_LT(standing, trials - trials / 12);
}

// Each verdict has a certificate that the check accepts, and no changed one is accepted.
TEST(Certificates, AreAcceptedAndDoNotSurviveMutation) {
  std::mt19937 random(11);
  const int trials = testing_support::trials(60, 10000);
  int standing = 0, falling = 0, pressed = 0, uncertain = 0;
  for (int trial = 0; trial < trials; ++trial) {
    SCOPED_TRACE(trial);
    const Pile pile = tilted(pile_of(random_pile(random), 1, 0.4), kY, static_cast<double>(random() % 3) * 7 * kDegree);
    const Judgement found = judge(pile);
    const std::size_t body = 1 + random() % (pile.bodies.size() - 1);
    if (found.verdict == Verdict::stands || found.verdict == Verdict::pressed_in) {
      ASSERT_EQ(check_equilibrium(pile, found.forces), "");
      ContactForces forces = found.forces;
      std::size_t contact = random() % forces.size();
      while (pile.contacts[contact].a == 0 && pile.contacts[contact].b == 0) contact = random() % forces.size();
      forces[contact][0] += 0.01 * pile.bodies[body].weight * Vec3::Random();
      EXPECT_NE(check_equilibrium(pile, forces), "");
      Pile heavier = pile;
      heavier.bodies[body].weight *= 1.01;
      EXPECT_NE(check_equilibrium(heavier, found.forces), "");
    }
    if (found.verdict == Verdict::pressed_in) {
      ASSERT_EQ(check_pressed_in(pile, found.forces, found.others, found.slide), "");
      ContactForces others = found.others;
      std::size_t contact = random() % others.size();
      while (pile.contacts[contact].a == 0 && pile.contacts[contact].b == 0) contact = random() % others.size();
      others[contact][0] += 0.01 * pile.bodies[body].weight * Vec3::Random();
      EXPECT_NE(check_pressed_in(pile, found.forces, others, found.slide), "");
      Motions slide = found.slide;
      for (Motion& m : slide) m = {-m.v, -m.w};
      EXPECT_NE(check_pressed_in(pile, found.forces, found.others, slide), "");
      EXPECT_NE(check_pressed_in(pile, found.forces, found.forces, found.slide), "");
    }
    if (found.verdict == Verdict::stands) {
      ASSERT_EQ(check_created(pile, found.forces, found.displacement), "");
      Motions lifted = found.displacement;
      for (Motion& m : lifted) m.v = -m.v;
      EXPECT_NE(check_created(pile, found.forces, lifted), "");
      ++standing;
    } else if (found.verdict == Verdict::falls) {
      ASSERT_EQ(check_fall(pile, found.motion), "");
      Motions motion = found.motion;
      for (Motion& m : motion) m = {-m.v, -m.w};
      EXPECT_NE(check_fall(pile, motion), "");
      motion = found.motion;
      motion[0].v = Vec3::UnitZ();
      EXPECT_NE(check_fall(pile, motion), "");
      ++falling;
    } else {
      ++(found.verdict == Verdict::pressed_in ? pressed : uncertain);
      if (found.verdict == Verdict::uncertain) {
        EXPECT_EQ(check_flips(flips_of(pile)), "");
      }
    }
  }
  RecordProperty("standing", standing);
  RecordProperty("falling", falling);
  RecordProperty("pressed_in", pressed);
  RecordProperty("uncertain", uncertain);
  EXPECT_GT(std::min(standing, falling), trials / 12);
  EXPECT_LE(uncertain, trials / 50);
}

}  // namespace
}  // namespace dismantle::statics
