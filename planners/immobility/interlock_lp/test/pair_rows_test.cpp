// The half spaces of a pair hold every pose at which no sample is inside its obstacle, and cut others off.
#include "interlock_lp/pair_rows.h"

#include <gtest/gtest.h>

#include "dismantle/testing/held_shapes.h"
#include "dismantle/testing/trials.h"

namespace dismantle {
namespace {

using immobility::Vector6;
using shapes::Vec3;

Vector6 random_pose_within(Rng& rng, const Vector6& lo, const Vector6& hi) {
  Vector6 x;
  for (int i = 0; i < 6; ++i) {
    const double share = rng.uniform(0, 1) < 0.3 ? std::round(rng.uniform(0, 1)) : rng.uniform(0, 1);
    x[i] = lo[i] + share * (hi[i] - lo[i]);
  }
  return x;
}

/// Poses of a pair, along axes, and its half spaces over some of them.
struct Poses {
  const immobility::SampledPair& pair;
  Eigen::Quaterniond axes;
  std::vector<immobility::PairRow> rows;

  Poses(const immobility::SampledPair& p, const Eigen::Quaterniond& along, const Vector6& lo, const Vector6& hi)
      : pair(p), axes(along), rows(pair_rows(p, along, lo, hi)) {}

  bool free(const Vector6& ours) const {
    Vector6 x;
    x << axes * ours.head<3>(), axes * ours.tail<3>();
    const immobility::RelativePose pose(pair, x);
    return std::none_of(pair.samples().begin(), pair.samples().end(),
                        [&](const immobility::InteriorSample& sample) { return pose.inside(sample); });
  }
  bool held(const Vector6& ours) const {
    return std::all_of(rows.begin(), rows.end(),
                       [&](const immobility::PairRow& r) { return r.normal.dot(ours) <= r.most; });
  }
  /// The last free pose on a segment that starts free: there the half spaces are closest.
  Vector6 last_free(Vector6 in, Vector6 out) const {
    for (int halving = 0; halving < 14; ++halving) {
      const Vector6 middle = 0.5 * (in + out);
      (free(middle) ? in : out) = middle;
    }
    return in;
  }
};

TEST(PairRows, HoldEveryFreePose) {
  Rng rng(5);
  int cut_off = 0;
  for (int i = 0; i < testing_support::trials(3, 12); ++i) {
    const shapes::Cased c{{0.5, 0.35, 0.3}, rng.uniform(0.01, 0.03), 0.2, 0.15};
    const Pose turned = shapes::random_pose(rng, 1);
    const auto block = immobility::split_into_solids(shapes::moved(c.block(), turned));
    const auto around = immobility::split_into_solids(shapes::moved(c.around(), turned));
    const bool swap = i % 2 == 1;  // then the case moves, and the block stays
    const immobility::SampledPair pair(swap ? around : block, swap ? block : around, 0.005, 0.02);
    const Eigen::Quaterniond axes = i % 3 == 0 ? Eigen::Quaterniond::Identity() : turned.q;
    Vector6 lo, hi;
    for (int d = 0; d < 6; ++d)
      lo[d] = -rng.uniform(0.03, d < 3 ? 0.12 : 0.04), hi[d] = rng.uniform(0.03, d < 3 ? 0.12 : 0.04);
    const Poses poses(pair, axes, lo, hi);
    for (int k = 0; k < 300; ++k) {
      Vector6 along = random_pose_within(rng, lo, hi);
      if (k % 2 == 0) along.tail<3>() *= rng.uniform(0, 1);
      if (k % 3 == 0) along[k % 6] = 0;
      const Vector6 x = poses.last_free(Vector6::Zero(), along);
      ASSERT_TRUE(poses.held(x)) << i << ": " << x.transpose();
      const Vector6 corner = along.cwiseSign().cwiseProduct(lo.cwiseAbs().cwiseMin(hi));
      cut_off += poses.held(corner) ? 0 : 1;
    }
  }
  EXPECT_GT(cut_off, 75 * testing_support::trials(3, 12)) << "a quarter, so that the rows say something";
}

/// A small block in front of a large face: only points of the block matter, whichever of the two moves. They touch
/// where both have turned and shifted as far as may be.
TEST(PairRows, HoldFarFromWhereTheyWereAssembled) {
  Rng rng(6);
  const auto wall = immobility::split_into_solids(shapes::box({-2, -2, -1}, {2, 2, 0}));
  const auto block = immobility::split_into_solids(shapes::box({-0.4, -0.3, 0.02}, {0.4, 0.3, 0.6}));
  int touching = 0;
  for (const bool wall_moves : {false, true}) {
    const immobility::SampledPair pair(wall_moves ? wall : block, wall_moves ? block : wall, 0.005, 0.02);
    Vector6 most;
    most << 0.1, 0.1, 0.1, 0.25, 0.25, 0.2;
    const Poses poses(pair, Eigen::Quaterniond::Identity(), -most, most);
    ASSERT_FALSE(poses.rows.empty());
    for (int k = 0; k < 1000; ++k) {
      Vector6 apart = random_pose_within(rng, -most, most), together = apart;
      apart[5] = wall_moves ? -most[5] : most[5];
      together[5] = -apart[5];
      if (!poses.free(apart) || poses.free(together)) continue;
      const Vector6 x = poses.last_free(apart, together);
      ASSERT_TRUE(poses.held(x)) << (wall_moves ? "wall: " : "block: ") << x.transpose();
      ++touching;
    }
  }
  EXPECT_GT(touching, 1000);
}

}  // namespace
}  // namespace dismantle
