// Chords across bodies of known width, and poses that match them.
#include "narrow_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solids.h"

namespace dismantle::tunnel_forest {
namespace {

using namespace path::test;

constexpr std::size_t kSamples = 1000;

bool is_one_of(double value, std::initializer_list<double> expected) {
  return std::any_of(expected.begin(), expected.end(), [&](double e) { return std::abs(e - value) < 1e-9; });
}

TEST(NarrowPlaces, ABoxHasBarsOfItsEdgesAndNoGaps) {
  Rng rng(1);
  for (int k = 0; k < 20; ++k) {
    const double a = rng.uniform(0.1, 3), b = rng.uniform(0.1, 3), c = rng.uniform(0.1, 3);
    const Pose pose{Vector3d(rng.normal(), rng.normal(), rng.normal()), random_turn(rng)};
    const NarrowPlaces found = find_narrow_places(moved(boxes({block(0, 0, 0, a, b, c)}), pose), kSamples, rng);
    EXPECT_TRUE(found.gaps.empty());
    EXPECT_GT(found.bars.size(), kSamples * 9 / 10);
    for (const auto& bar : found.bars) {
      EXPECT_TRUE(is_one_of(2 * bar.half_width, {a, b, c})) << bar.half_width;
      const Vector3d local = pose.inverse() * bar.middle, axis = pose.q.conjugate() * bar.axis;
      EXPECT_NEAR(axis.cwiseAbs().maxCoeff(), 1, 1e-9);
      EXPECT_GT(local.minCoeff(), -1e-9);
      // The middle of a chord is halfway between two faces.
      Eigen::Index along = 0;
      axis.cwiseAbs().maxCoeff(&along);
      EXPECT_NEAR(local[along], 0.5 * Vector3d(a, b, c)[along], 1e-9);
    }
  }
}

TEST(NarrowPlaces, TwoPlatesHaveTheGapBetweenThem) {
  Rng rng(2);
  for (int k = 0; k < 20; ++k) {
    const double gap = rng.uniform(0.05, 1);
    const Pose pose{Vector3d::Zero(), random_turn(rng)};
    const Mesh plates = boxes({block(0, 0, 0, 2, 2, 1), block(0, 0, 1 + gap, 2, 2, 2 + gap)});
    const NarrowPlaces found = find_narrow_places(moved(plates, pose), kSamples, rng);
    EXPECT_GT(found.gaps.size(), kSamples / 10);
    for (const auto& g : found.gaps) {
      EXPECT_NEAR(2 * g.half_width, gap, 1e-9);
      EXPECT_NEAR((pose.inverse() * g.middle).z(), 1 + 0.5 * gap, 1e-9);
    }
  }
}

TEST(NarrowPlaces, AnEmptyMeshHasNone) {
  Rng rng(3);
  const NarrowPlaces none = find_narrow_places({}, kSamples, rng);
  EXPECT_TRUE(none.gaps.empty() && none.bars.empty());
  EXPECT_TRUE(TunnelPoses({}, {}, 1.25).empty());
}

TEST(TunnelPoses, BringNarrowPlacesTogether) {
  Rng rng(4);
  const NarrowPlaces ring = find_narrow_places(open_ring(0.6), kSamples, rng);
  const NarrowPlaces bar = find_narrow_places(boxes({block(0, 0, 0, 5, 0.5, 0.5)}), kSamples, rng);
  const TunnelPoses poses(bar, ring, 1.25);
  ASSERT_FALSE(poses.empty());
  for (int k = 0; k < 200; ++k) {
    const auto match = poses.draw(rng);
    EXPECT_LT((match.displacement * match.on_moving - match.on_fixed).norm(), 1e-9);
    EXPECT_NEAR(match.displacement.q.norm(), 1, 1e-9);
    EXPECT_GT(match.reach, 0);
    EXPECT_TRUE(std::any_of(ring.gaps.begin(), ring.gaps.end(),
                            [&](const NarrowPlace& g) { return g.middle == match.on_fixed; }));
  }
}

TEST(TunnelPoses, WideGapsAreNone) {
  Rng rng(5);
  // The hole of the ring and its gap are four times as wide as the bar.
  const NarrowPlaces ring = find_narrow_places(open_ring(1.9), kSamples, rng);
  EXPECT_FALSE(ring.gaps.empty());
  EXPECT_TRUE(TunnelPoses(find_narrow_places(boxes({block(0, 0, 0, 5, 0.5, 0.5)}), kSamples, rng), ring, 1.25).empty());
}

}  // namespace
}  // namespace dismantle::tunnel_forest
