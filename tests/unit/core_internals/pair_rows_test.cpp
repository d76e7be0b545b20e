// The half spaces of a pair hold every pose at which no pin is inside what it faces, and cut others off.
#include "verify/interlock/pair_rows.h"

#include <gtest/gtest.h>

#include "held_shapes.h"

namespace dismantle {
namespace {

using shapes::Vec3;
using verify::Vector6;

Vector6 random_pose_within(Rng& rng, const Vector6& lo, const Vector6& hi) {
  Vector6 x;
  for (int i = 0; i < 6; ++i) {
    const double share = rng.uniform(0, 1) < 0.3 ? std::round(rng.uniform(0, 1)) : rng.uniform(0, 1);
    x[i] = lo[i] + share * (hi[i] - lo[i]);
  }
  return x;
}

TEST(PairRows, HoldWhateverThePinsAllow) {
  Rng rng(5);
  std::size_t cut_off = 0;
  for (int i = 0; i < 6; ++i) {
    const shapes::Cased c{{0.5, 0.35, 0.3}, rng.uniform(0.01, 0.03), 0.2, 0.15};
    const Pose turned = shapes::random_pose(rng, 1);
    auto block = verify::split_into_solids(shapes::moved(c.block(), turned));
    auto around = verify::split_into_solids(shapes::moved(c.around(), turned));
    const bool swap = i % 2 == 1;  // then the case moves, and the block stays
    const verify::Pinned pinned(swap ? around : block, swap ? block : around, 0.005);
    ASSERT_FALSE(pinned.pins().empty());
    const Eigen::Quaterniond axes = i % 3 == 0 ? Eigen::Quaterniond::Identity() : turned.q;
    Vector6 lo, hi;
    for (int d = 0; d < 6; ++d)
      lo[d] = -rng.uniform(0.03, d < 3 ? 0.12 : 0.04), hi[d] = rng.uniform(0.03, d < 3 ? 0.12 : 0.04);
    const auto rows = pair_rows(pinned, axes, lo, hi);
    ASSERT_FALSE(rows.empty());
    const auto free = [&](const Vector6& ours) {
      Vector6 x;
      x << axes * ours.head<3>(), axes * ours.tail<3>();
      const verify::Stance stance(pinned, x);
      return std::none_of(pinned.pins().begin(), pinned.pins().end(),
                          [&](const verify::Pin& pin) { return stance.inside(pin); });
    };
    for (int k = 0; k < 300; ++k) {
      // As far along a line as the pins allow: there the half spaces are closest.
      Vector6 along = random_pose_within(rng, lo, hi);
      if (k % 2 == 0) along.tail<3>() *= rng.uniform(0, 1);
      if (k % 3 == 0) along[k % 6] = 0;
      double in = 0, out = 1;
      for (int halving = 0; halving < 12; ++halving) {
        const double middle = 0.5 * (in + out);
        (free(middle * along) ? in : out) = middle;
      }
      const auto held = [&](const Vector6& x) {
        return std::all_of(rows.begin(), rows.end(),
                           [&](const verify::PairRow& r) { return r.normal.dot(x) <= r.most; });
      };
      ASSERT_TRUE(held(in * along)) << i << ": " << in * along.transpose();
      const Vector6 corner = along.cwiseSign().cwiseProduct(lo.cwiseAbs().cwiseMin(hi));
      cut_off += held(corner) ? 0 : 1;
    }
  }
  EXPECT_GT(cut_off, 900u);
}

}  // namespace
}  // namespace dismantle
