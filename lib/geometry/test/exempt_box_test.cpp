// Motions past an exempt box, in which the depth has no limit.
#include <gtest/gtest.h>

#include "dismantle/geometry/pair_check.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::geometry {
namespace {

using shapes::Vec3;

/// A block whose side is `overlap` deep in the rim of a plate, as CAD parts are, slides up along the rim. All that is
/// in the plate is in the exempt box. A nose of the plate hangs over the rim, above the box: `over` beyond the rim,
/// along the block or beside it.
struct BlockAtRim {
  Solid block, plate;
  RelativeMotion forward, backward;
  Aabb exempt;
};

BlockAtRim block_at_rim(const Vec3& origin, double overlap, double over, double nose_from, double nose_to) {
  const auto box = [&](Vec3 lo, Vec3 hi) { return shapes::box(origin + lo, origin + hi); };
  Mesh plate = shapes::joined(box({0, 0, -1}, {10, 10, 0}), box({5, 4, -0.5}, {6, 5, 1.5}));
  plate = shapes::joined(plate, box({-over, nose_from, 1}, {5.5, nose_to, 1.2}));
  Solid a(box({-2, 2, -1}, {overlap, 8, 0.5})), b(plate);
  const std::vector<Pose> up{a.frame, Pose{{0, 0, 2.5}, Eigen::Quaterniond::Identity()} * a.frame};
  Aabb around_a = a.box, around_b = b.box;
  around_a.inflate(1);
  around_b.inflate(1);
  RelativeMotion forward(up, {b.frame}, around_a), backward({b.frame}, up, around_b);
  return {std::move(a),
          std::move(b),
          std::move(forward),
          std::move(backward),
          {origin + Vec3(-2 * overlap, 1.9, -1.1), origin + Vec3(2 * overlap, 8.1, 2 * overlap)}};
}

TEST(ExemptBox, WhatSticksOutOfItIsProvedWhereNothingIs) {
  Rng rng(41);
  const double tolerance = 0.001;
  int proved = 0, refused = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Vec3 origin(rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-9, 9));
    const double overlap = rng.uniform(0.004, 0.1), over = rng.uniform(-3, 3) * overlap, from = rng.uniform(0, 9);
    const double to = from + rng.uniform(0.3, 1);
    const bool beside = to < 2 - 2 * tolerance || from > 8 + 2 * tolerance,
               cuts = !beside && overlap + over > 2 * tolerance;
    if (!cuts && !beside && overlap + over > -tolerance) continue;  // about as deep as allowed
    const BlockAtRim at = block_at_rim(origin, overlap, over, from, to);
    const Limits limits{0, tolerance, &at.exempt, tolerance, overlap + tolerance};
    Budget budget{20'000, 2'000};
    const Finding found = check_pair(at.block, at.plate, at.forward, at.backward, limits, budget);
    EXPECT_EQ(found.answer == Answer::certified, !cuts) << trial << ": over " << over << ", overlap " << overlap;
    ++(cuts ? refused : proved);
  }
  EXPECT_GT(proved, 15);
  EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace dismantle::geometry
