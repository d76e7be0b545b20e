// Several bodies between two walls: what only pressure keeps up, and what becomes an arch.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "dismantle/statics/certificates.h"
#include "dismantle/statics/limits.h"
#include "dismantle/statics/verdict.h"
#include "piles.h"

namespace dismantle::statics {
namespace {

using namespace testing;
using Vec3 = Eigen::Vector3d;

/// n blocks of unit width between two walls, nothing below. The joints lean to the left and to the right in turn, by
/// `slope`.
std::vector<Mesh> chain(int n, double height, double slope = 0) {
  std::vector<Mesh> meshes = {box({-2, -1, -4}, {0, 2, 4}), box({1.0 * n, -1, -4}, {n + 2.0, 2, 4})};
  const auto lean = [&](int joint) { return joint == 0 || joint == n ? 0 : joint % 2 == 0 ? -slope : slope; };
  for (int k = 0; k < n; ++k)
    meshes.push_back(bent_box({1.0 * k, 0, -0.5 * height}, {k + 1.0, 1, 0.5 * height}, [&](const Vec3& p) {
      return Vec3(p.x() + lean(static_cast<int>(std::lround(p.x()))) * p.z(), p.y(), p.z());
    }));
  return meshes;
}

// Blocks that are wider above than below hang between those that are wider below: nothing presses them together.
TEST(Wedged, AChainOfWedgesIsPressedIn) {
  for (const auto& [degrees, friction] : {std::pair(5.0, 0.2), {10.0, 0.4}, {15.0, 0.3}, {20.0, 0.5}})
    for (int n = 2; n <= 8; ++n) {
      const Pile pile = pile_of(chain(n, 1, std::tan(degrees * M_PI / 180)), 2, friction);
      const Judgement found = judge(pile);
      ASSERT_EQ(found.verdict, Verdict::pressed_in) << n << " blocks, " << degrees << " degrees";
      EXPECT_EQ(check_pressed_in(pile, found.forces, found.others, found.slide), "");
    }
}

// Blocks in a row give way in the middle: the joints open below, but for those at the walls, which open above. So they
// press on each other as an arch does, from the lower edges at the walls to the upper edges in the middle. The weight
// of half the row on each wall, n / 2, needs a thrust of n / (2 friction) or more; the moment in the middle gives n^2 /
// (8 height), or (n^2 - 1) / (8 height) if a block is there and no joint.
TEST(Wedged, ARowOfBlocksIsAnArchWhereFrictionIsEnough) {
  const double height = 0.5;
  for (int n = 2; n <= 24; n += n < 8 ? 1 : 4) {
    const double thrust = (n * n - n % 2) / (8 * height), least = 0.5 * n / thrust;
    EXPECT_EQ(judge(pile_of(chain(n, height), 2, 0.98 * least)).verdict, Verdict::pressed_in) << n;
    EXPECT_EQ(judge(pile_of(chain(n, height), 2, 1.02 * least)).verdict, Verdict::stands) << n;
  }
}

// A block of a long arch between walls that lies still: no push along the row, nor across it, is too much for its
// neighbours and their friction.
TEST(Wedged, NoPushMovesABlockOfALongRow) {
  const Pile pile = pile_of(chain(60, 1), 2, 0.2);
  for (const std::uint32_t body : {2U, 30U, 60U}) EXPECT_FALSE(least_push(pile, body)) << body;
}

}  // namespace
}  // namespace dismantle::statics
