// Motions past an exempt box, in which the depth has no limit.
#include "motion/exempt_box.h"

#include <gtest/gtest.h>

#include <array>

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

BlockAtRim block_at_rim(const Vec3& origin, double overlap, double over, const std::array<double, 2>& nose, double side,
                        double top) {
  const auto box = [&](Vec3 lo, Vec3 hi) { return shapes::box(origin + lo, origin + hi); };
  Mesh plate = shapes::joined(box({0, side + 0.1, -1}, {10, 9.9 - side, 0}), box({5, 4, -0.5}, {6, 5, 1.5}));
  plate = shapes::joined(plate, box({-over, nose[0], 1}, {5.5, nose[1], 1.2}));
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
          {origin + Vec3(-2 * overlap, side, -1.1), origin + Vec3(2 * overlap, 10 - side, top)}};
}

TEST(ExemptBox, WhatSticksOutOfItIsProvedWhereNothingIs) {
  Rng rng(41);
  const double tolerance = 0.001;
  int proved = 0, refused = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Vec3 origin(rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-9, 9));
    const double overlap = rng.uniform(0.004, 0.1);
    // Odd: all faces that cut reach into the box, and cut beside it.
    const bool across = trial % 2 == 1;
    const double over = rng.uniform(-3, across ? 2 : 3) * overlap, from = across ? -1 : rng.uniform(0, 9);
    const double to = across ? 11 : from + rng.uniform(0.3, 1), top = across ? rng.uniform(0.55, 0.8) : 0.3;
    const bool beside = to < 2 - 2 * tolerance || from > 8 + 2 * tolerance;
    const bool cuts = !beside && overlap + over > 2 * tolerance;
    if (!cuts && !beside && overlap + over > -tolerance) continue;  // about as deep as allowed
    const BlockAtRim at = block_at_rim(origin, overlap, over, {from, to}, across ? 3 : 1.8, top);
    const Limits limits{0, tolerance, &at.exempt, tolerance};
    Budget budget{20'000, 2'000};
    const Finding found = check_pair(at.block, at.plate, at.forward, at.backward, limits, budget);
    EXPECT_EQ(found.answer == Answer::certified, !cuts) << trial << ": over " << over << ", overlap " << overlap;
    ++(cuts ? refused : proved);
  }
  EXPECT_GT(proved, 15);
  EXPECT_GT(refused, 10);
}

/// Against points of the swept hull outside of the box: none is in the solid. Solid and triangle are turned at random.
TEST(ExemptBox, NothingOfASolidIsOutsideWhereItIsSaidToBeFree) {
  Rng rng(43);
  const auto point = [&](double size) {
    return Vec3(rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size));
  };
  int free = 0, met = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Pose turned{point(1),
                      Eigen::Quaterniond(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1), 1).normalized()};
    const Solid solid(shapes::moved(shapes::box({-1, -1, -0.2}, {1, 1, 0.2}), turned));
    const Vec3 from = turned * point(1.4), by = point(1);
    const double margin = trial % 3 == 0 ? 0.05 : 0;
    Corners begin, end;
    for (std::size_t k = 0; k < 3; ++k) {
      begin[k] = solid.frame.inverse() * (from + point(0.5));
      end[k] = begin[k] + by + (trial % 5 == 0 ? point(0.2) : Vec3::Zero());
    }
    Aabb inner;
    inner.extend(from);
    inner.extend(from + point(3));
    inner.inflate(0.3);
    const bool said = is_free_outside(solid, Sweep(begin, end, margin), inner);
    bool any = false;
    for (int k = 0; k < 500; ++k) {
      Vec3 x = Vec3::Zero();
      double sum = 0;
      for (const Corners* corners : {&begin, &end})
        for (const Vec3& p : *corners) {
          const double weight = rng.uniform(0, 1);
          sum += weight;
          x += weight * p;
        }
      x = x / sum + margin * point(0.5);
      if (!inner.contains(solid.frame * x) && solid.bvh.inside(x)) any = true;
    }
    EXPECT_FALSE(said && any) << trial;
    ++(said ? free : met);
    if (trial % 2 == 0) continue;
    Aabb around;
    for (const Corners* corners : {&begin, &end})
      for (const Vec3& p : *corners) around.extend(solid.frame * p);
    around.inflate(0.1);
    EXPECT_TRUE(is_free_outside(solid, Sweep(begin, end, margin), around)) << trial;
  }
  EXPECT_GT(free, 30);
  EXPECT_GT(met, 30);
}

}  // namespace
}  // namespace dismantle::geometry
