#include "dismantle/statics/limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>

#include "dismantle/statics/budget.h"
#include "dismantle/statics/holds.h"
#include "piles.h"

namespace dismantle::statics {
namespace {

using namespace testing;
using Vec3 = Eigen::Vector3d;

constexpr double kDegrees = M_PI / 180;

TEST(CriticalTilt, IsTheAngleOfFrictionOrOfToppling) {
  const Mesh ground = box({-5, -5, -1}, {5, 5, 0});
  const Pile pile = pile_of({ground, box({-0.25, -1, 0}, {0.25, 1, 1})}, 1, 0.7);
  EXPECT_NEAR(*critical_tilt(pile, Vec3::UnitY()) / kDegrees, 26.565, 0.05);  // topples
  EXPECT_NEAR(*critical_tilt(pile, -Vec3::UnitY()) / kDegrees, 26.565, 0.05);
  EXPECT_NEAR(*critical_tilt(pile, Vec3::UnitX()) / kDegrees, std::atan(0.7) / kDegrees, 0.05);  // slides
}

TEST(CriticalTilt, OfAnArchIsThatOfThePaper) {
  // 36 free voussoirs on two supports, thickness by radius 0.150: 8.2 degrees.
  std::vector<Mesh> meshes;
  const auto voussoir = [](double from, double to) {
    return bent_box({from, -0.5, 0.925}, {to, 0.5, 1.075},
                    [](const Vec3& p) { return Vec3(-p.z() * std::cos(p.x()), p.y(), p.z() * std::sin(p.x())); });
  };
  const double step = M_PI / 36;
  meshes.push_back(voussoir(-step, 0));
  meshes.push_back(voussoir(M_PI, M_PI + step));
  for (int k = 0; k < 36; ++k) meshes.push_back(voussoir(k * step, (k + 1) * step));
  const auto tilt = critical_tilt(pile_of(meshes, 2, 1.0), Vec3::UnitY());
  ASSERT_TRUE(tilt);
  EXPECT_NEAR(*tilt / kDegrees, 8.2, 0.08);
}

// Rows of bricks on each other. What the search says of its end is certified, and a budget ends it at the same point
// each time.
TEST(TiltLimit, IsBetweenItsCertificatesAndEndsWithItsBudget) {
  std::vector<Mesh> meshes{box({-5, -5, -1}, {20, 5, 0})};
  for (int row = 0; row < 6; ++row)
    for (int k = 0; k < 6; ++k) {
      const double x = k + 0.3 * (row % 2), z = 0.4 * row;
      meshes.push_back(box({x, 0, z}, {x + 1, 0.5, z + 0.4}));
    }
  const Pile pile = pile_of(meshes, 1, 0.6);
  const Judgement judged = judge(pile);
  ASSERT_EQ(judged.verdict, Verdict::stands);
  const TiltLimit whole = tilt_limit(pile, Vec3::UnitX(), judged.displacement);
  ASSERT_TRUE(whole.found && whole.angle && whole.falls);
  EXPECT_NEAR(*whole.angle / kDegrees, std::atan(0.5 / 2.4) / kDegrees, 0.1);  // the wall topples as a whole
  EXPECT_EQ(judge(tilted(pile, Vec3::UnitX(), whole.stands)).verdict, Verdict::stands);
  EXPECT_EQ(judge(tilted(pile, Vec3::UnitX(), *whole.falls + 1e-4)).verdict, Verdict::falls);
  EXPECT_LT(*whole.falls - whole.stands, 0.02 * *whole.angle);
  TiltLimit ended[2];
  for (TiltLimit& limit : ended) {
    const Budget budget(10e6);
    limit = tilt_limit(pile, Vec3::UnitX(), judged.displacement, [&] { return budget.spent(); });
    EXPECT_FALSE(limit.found);
    EXPECT_LT(limit.stands, whole.stands);
    EXPECT_EQ(limit.angle, limit.stands);
  }
  EXPECT_EQ(ended[0].stands, ended[1].stands);
}

// A drawer: its tongue is under a ceiling, its rims are on legs. The weight presses the front of the rims, and the
// tongue a little against the ceiling, by how stiff both are: it slides at the angle of friction, or a little above.
TEST(CriticalTilt, OfADrawerIsNearTheAngleOfFriction) {
  const auto solid = [](std::initializer_list<Mesh> boxes) {
    Mesh all;
    for (const Mesh& m : boxes) {
      const auto first = static_cast<std::uint32_t>(all.vertices.size());
      all.vertices.insert(all.vertices.end(), m.vertices.begin(), m.vertices.end());
      for (const Triangle& t : m.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    return all;
  };
  const Mesh chest = solid({box({-1.5, -0.5, 0}, {-0.8, 0.5, 0.1}), box({-0.8, -0.5, 0}, {0.1, -0.3, 0.1}),
                            box({-0.8, 0.3, 0}, {0.1, 0.5, 0.1}), box({-1.5, -0.5, 0.1}, {-0.5, 0.5, 0.2})});
  const Mesh drawer = solid({box({-0.8, -0.3, 0}, {1, 0.3, 0.1}), box({-0.5, -0.5, 0.1}, {0.1, 0.5, 0.2})});
  for (const double friction : {0.1, 0.3, 0.84}) {
    const auto tilt = critical_tilt(pile_of({chest, drawer}, 1, friction), Vec3::UnitY());
    ASSERT_TRUE(tilt);
    EXPECT_GT(*tilt, std::atan(friction) - 0.1 * kDegrees) << friction;
    EXPECT_LT(*tilt / kDegrees, std::atan(friction) / kDegrees + 1.2) << friction;
  }
}

TEST(LeastPush, OfASlabOnTwoLegs) {
  const Mesh ground = box({-5, -5, -1}, {5, 5, 0});
  Pile pile = pile_of({ground, box({-2, -1, 0}, {-1, 1, 1}), box({1, -1, 0}, {2, 1, 1}), box({-2, -1, 1}, {2, 1, 1.2})},
                      1, 0.5);
  pile.bodies[1].weight = pile.bodies[2].weight = 9.81;
  pile.bodies[3].weight = 3 * 9.81;
  const auto push = least_push(pile, 3);
  ASSERT_TRUE(push);
  EXPECT_NEAR(push->force, 14.7, 0.1);
}

TEST(LeastHolds, AgreeWithBruteForce) {
  std::mt19937 random(3);
  int some = 0;
  for (int trial = 0; trial < 25; ++trial) {
    const int n = 3 + static_cast<int>(random() % 4);
    std::vector<Mesh> meshes = {box({-5, -5, -1}, {5, 5, 0})};
    for (int k = 0; k < n; ++k) {
      const double x = 0.5 * static_cast<double>(random() % 12) - 3, z = 0.5 * (k / 2);
      meshes.push_back(box({x, 0, z}, {x + 1.5, 1, z + 0.5}));
    }
    // Blocks of one layer may overlap; their contact is then a wall, which is as good as any.
    const Pile pile = pile_of(meshes, 1, 0.4);
    const Holds holds = least_holds(pile);
    ASSERT_TRUE(holds.found);
    std::size_t least = static_cast<std::size_t>(n);
    for (unsigned set = 0; set < (1u << n); ++set) {
      Pile held = pile;
      for (int i = 0; i < n; ++i)
        if (set & (1u << i)) held.bodies[static_cast<std::size_t>(i) + 1].fixed = true;
      if (judge(held).verdict == Verdict::stands)
        least = std::min(least, static_cast<std::size_t>(__builtin_popcount(set)));
    }
    EXPECT_EQ(holds.held.size(), least) << trial;
    some += least > 0;
  }
  EXPECT_GT(some, 5);
}

}  // namespace
}  // namespace dismantle::statics
