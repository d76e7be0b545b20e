// Samples that prove penetration of a motion.
#include "dismantle/geometry/motion_samples.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "dismantle/geometry/pair_check.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::geometry {
namespace {

using shapes::Vec3;

/// A peg that moves in its sleeve, about as deep into the wall as allowed: stopping at the first bad sample gives the
/// same answer as taking all samples, and never contradicts the proof.
TEST(Sampling, StopsAtWhatTheProofWouldFindToo) {
  Rng rng(17);
  int beyond = 0, within = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Limits limits{rng.below(2) * rng.uniform(0, 0.01), rng.uniform(0.002, 0.01)};
    const Solid a(shapes::tube(0.3, 1, -1, 1, 40, 6)), b(shapes::tube(1, 1.4, -1.2, 1.2, 40, 3));
    const Vec3 aside(rng.uniform(0, 2.2) * limits.most(), 0, rng.uniform(0, 1));
    std::vector<Pose> there{Pose{}, Pose{aside, Eigen::Quaterniond::Identity()}};
    if (trial % 2 == 0)  // so long a way that only what is near is sampled
      for (int k = 0; k < 18; ++k) there.push_back({aside + k * Vec3(0, 0, 0.01), there.back().q});
    std::vector<Pose> poses;
    for (const Pose& p : there) poses.push_back(p * a.frame);
    Aabb around_a = a.box, around_b = b.box;
    around_a.inflate(limits.most());
    around_b.inflate(limits.most());
    const RelativeMotion forward(poses, {b.frame}, around_a), backward({b.frame}, poses, around_b);
    const Finding deepest = deepest_sample(a, b, forward, backward);
    const bool stopped = sample_beyond(a, b, forward, backward, limits);
    EXPECT_EQ(stopped, deepest.depth > limits.at(deepest.thickness)) << trial;  // the walls are equally thick here
    const bool early = sample_beyond(a, b, forward, backward, limits, SampledTimes::some),
               late = sample_beyond(a, b, forward, backward, limits, SampledTimes::others);
    EXPECT_EQ(stopped, early || late) << trial;
    ++(stopped ? beyond : within);
    if (!stopped) continue;
    Budget budget{1'000'000, 80'000};
    EXPECT_NE(check_pair(a, b, forward, backward, limits, budget).answer, Answer::certified) << trial;
  }
  EXPECT_GT(beyond, 15);
  EXPECT_GT(within, 15);
}

/// What slides along a face touches it, up to rounding: no sample of that is deeper than a wall without thickness
/// allows.
TEST(Sampling, TouchingIsNoPenetration) {
  Rng rng(23);
  for (int trial = 0; trial < 40; ++trial) {
    const Pose turned{Vec3(rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(-5, 5)),
                      Eigen::Quaterniond(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1), 2).normalized()};
    const auto block = [&](const Vec3& from, const Vec3& to) {
      Mesh mesh = shapes::box(from, to);
      for (Vec3& v : mesh.vertices) v = turned * v;
      return Solid(mesh);
    };
    for (const double depth : {0.0, 1e-6}) {
      Solid a = block(Vec3(0, 0, -depth), Vec3(1, 1, 1));
      const Solid b = block(Vec3(-3, -3, -1), Vec3(3, 3, 0));
      std::fill(a.thickness.begin(), a.thickness.end(), 0.0);
      const Vec3 along = turned.q * Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), 0);
      const std::vector<Pose> poses{a.frame, Pose{along, Eigen::Quaterniond::Identity()} * a.frame};
      const RelativeMotion forward(poses, {b.frame}, a.box), backward({b.frame}, poses, b.box);
      EXPECT_EQ(sample_beyond(a, b, forward, backward, {0, 0.01}), depth > 0) << trial;
    }
  }
}

}  // namespace
}  // namespace dismantle::geometry
