// Boxes along a path contain the part at all times, and a reported separation is true.
#include "dismantle/geometry/swept_boxes.h"

#include <gtest/gtest.h>

#include "dismantle/run_context.h"

namespace dismantle::geometry {
namespace {

using Eigen::Vector3d;

Vector3d gaussian(Rng& rng) { return {rng.normal(), rng.normal(), rng.normal()}; }

std::vector<Pose> walk_of(Rng& rng, std::size_t segments) {
  std::vector<Pose> poses{{4 * gaussian(rng), rotation_from_vector(gaussian(rng))}};
  for (std::size_t k = 0; k < segments; ++k)
    poses.push_back(
        {poses.back().t + gaussian(rng), rotation_from_vector(0.5 * rng.uniform() * gaussian(rng)) * poses.back().q});
  return poses;
}

Aabb gaussian_box(Rng& rng) {
  Aabb box;
  box.extend(gaussian(rng));
  box.extend(gaussian(rng));
  return box;
}

Pose at(const std::vector<Pose>& poses, std::size_t segment, double u) {
  return poses.size() == 1 ? poses[0] : screw_interpolate(poses[segment], poses[segment + 1], u);
}

/// True if the second is further from the first than `distance` along an axis.
bool apart_by(const Aabb& a, const Aabb& b, double distance) {
  Aabb around = a;
  around.inflate(distance);
  return !around.overlaps(b);
}

TEST(SweptBoxes, HoldTheBoxAtAllTimes) {
  Rng rng(11);
  for (int trial = 0; trial < 100; ++trial) {
    const Aabb box = gaussian_box(rng);
    const auto path = walk_of(rng, 1 + rng.below(20));
    Aabb whole = SweptBoxes(path, box).whole();
    whole.inflate(1e-9);
    for (int sample = 0; sample < 50; ++sample) {
      const Pose pose = at(path, rng.below(path.size() - 1), rng.uniform());
      const Vector3d u(rng.uniform(), rng.uniform(), rng.uniform());
      EXPECT_TRUE(whole.contains(pose * (box.lo + u.cwiseProduct(box.size())))) << "trial " << trial;
    }
  }
}

/// Both parts move, or one is fixed: parts reported apart are apart at all times, and parts near at the end of a
/// segment are never reported apart.
TEST(SweptBoxes, MeetExactlyWhereBoxesOfTheSameTimeDo) {
  Rng rng(12);
  int met = 0, missed = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const std::size_t segments = 1 + rng.below(12);
    const Aabb box_a = gaussian_box(rng), box_b = gaussian_box(rng);
    const auto a = walk_of(rng, segments), b = walk_of(rng, trial % 2 == 0 ? segments : 0);
    const double distance = rng.uniform();
    const SweptBoxes boxes_a(a, box_a), boxes_b(b, box_b);
    const bool meets = boxes_a.meets(boxes_b, distance);
    EXPECT_EQ(meets, boxes_b.meets(boxes_a, distance));
    ++(meets ? met : missed);
    for (std::size_t k = 0; k < segments && !meets; ++k)
      for (const double u : {0.0, 0.3, 0.5, 0.9, 1.0})
        EXPECT_TRUE(apart_by(box_under(box_a, at(a, k, u)), box_under(box_b, at(b, k, u)), distance - 1e-9))
            << "trial " << trial << ", segment " << k;
  }
  EXPECT_GT(met, 40);
  EXPECT_GT(missed, 40) << "the test would be empty";
}

/// A detour around a part: the box of the whole path contains the part, those of the segments do not.
TEST(SweptBoxes, APathAroundAPartDoesNotMeetIt) {
  Aabb unit;
  unit.extend(Vector3d::Constant(-0.5));
  unit.extend(Vector3d::Constant(0.5));
  std::vector<Pose> path;
  for (const auto& [x, y] : {std::pair{-5, 0}, {-5, 5}, {5, 5}, {5, 0}})
    path.push_back({Vector3d(x, y, 0), Eigen::Quaterniond::Identity()});
  const SweptBoxes moving(path, unit), still({Pose{}}, unit);
  EXPECT_TRUE(moving.whole().overlaps(still.whole()));
  EXPECT_FALSE(moving.meets(still, 1));
  EXPECT_TRUE(moving.meets(still, 4.1));
}

}  // namespace
}  // namespace dismantle::geometry
