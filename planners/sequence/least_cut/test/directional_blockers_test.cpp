// Cached blockers of parts along directions, compared with a new query for each pair.
#include "least_cut/directional_blockers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "dismantle/geometry/boxes_along.h"
#include "dismantle/geometry/swept_boxes.h"
#include "dismantle/testing/run_rig.h"
#include "dismantle/testing/shapes.h"
#include "least_cut/forced_motions.h"

namespace dismantle::least_cut {
namespace {

using shapes::Vec3;

struct Question {
  std::vector<Aabb> boxes;
  double reach(const PlacedPart& p, const Vec3& along) const {
    const Aabb box = geometry::box_under(boxes[p.part], p.pose);
    return along.cwiseMax(0).dot(box.hi) + along.cwiseMin(0).dot(box.lo);
  }
  /// Boxes that are touched by one of many places along the way.
  double thickness(const PlacedPart& p, const PlacedPart& q, const Vec3& along) const {
    Aabb moving = geometry::box_under(boxes[p.part], p.pose);
    const Aabb fixed = geometry::box_under(boxes[q.part], q.pose);
    double count = 0;
    for (int k = 0; k < 400; ++k) {
      count += moving.overlaps(fixed) ? 1 : 0;
      moving.lo += 0.05 * along;
      moving.hi += 0.05 * along;
    }
    return count;
  }
};

Vec3 random_direction(Rng& rng) {
  if (rng.uniform() < 0.5) {
    Vec3 d = Vec3::Zero();
    d[static_cast<Eigen::Index>(rng.below(3))] = rng.uniform() < 0.5 ? 1 : -1;
    return d;
  }
  return Vec3(rng.normal(), rng.normal(), rng.normal()).normalized();
}

TEST(DirectionalBlockers, WhatMayNotMeetNeverDoes) {
  Rng rng(5);
  Question ask;
  int apart = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    ask.boxes.clear();
    for (int k = 0; k < 2; ++k) {
      const Vec3 lo(rng.uniform(-4, 4), rng.uniform(-4, 4), rng.uniform(-4, 4));
      ask.boxes.push_back({lo, lo + Vec3(rng.uniform(0.1, 2), rng.uniform(0.1, 2), rng.uniform(0.1, 2))});
    }
    const Vec3 d = random_direction(rng);
    if (geometry::meets_along(ask.boxes[0], ask.boxes[1], d)) continue;
    ++apart;
    EXPECT_EQ(ask.thickness({0, Pose{}}, {1, Pose{}}, d), 0) << "trial " << trial;
  }
  EXPECT_GT(apart, 500);
}

/// Parts leave one by one; sometimes a part is moved, sometimes units leave together.
TEST(DirectionalBlockers, AsIfEachPairWereAskedAnew) {
  Rng rng(7);
  for (int trial = 0; trial < 30; ++trial) {
    Question ask;
    std::vector<PlacedPart> group;
    const std::size_t n = 3 + rng.below(8);
    for (PartId k = 0; k < n; ++k) {
      const Vec3 lo(rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(-3, 3));
      ask.boxes.push_back({lo, lo + Vec3(rng.uniform(0.2, 2), rng.uniform(0.2, 2), rng.uniform(0.2, 2))});
      group.push_back({k, Pose{}});
    }
    std::vector<Vec3> directions;
    for (int k = 0; k < 5; ++k) directions.push_back(random_direction(rng));
    std::size_t asked = 0;
    DirectionalBlockers blockers(
        ask.boxes, [&](const PlacedPart& p, const Vec3& d) { return ask.reach(p, d); },
        [&](const PlacedPart& p, const PlacedPart& q, const Vec3& d) {
          ++asked;
          return ask.thickness(p, q, d);
        });
    while (group.size() > 1) {
      const bool moves = rng.uniform() < 0.2;
      if (moves) group[rng.below(group.size())].pose.t += 0.5 * random_direction(rng);
      const std::size_t before = asked;
      blockers.set_group(group);
      for (const Vec3& d : directions) {
        const DirectionalBlockers::Along along = blockers.along(d);
        for (std::size_t k = 0; k < group.size(); ++k) {
          std::vector<PlacedPart> unit{group[k]};
          if (k + 2 < group.size() && rng.uniform() < 0.3) unit.push_back(group[k + 1]);
          double thickness = 0, ahead = -std::numeric_limits<double>::infinity(), behind = ahead;
          for (const PlacedPart& q : group) {
            const bool in_unit =
                std::any_of(unit.begin(), unit.end(), [&](const PlacedPart& p) { return p.part == q.part; });
            (in_unit ? behind : ahead) = std::max(in_unit ? behind : ahead, ask.reach(q, in_unit ? -d : d));
            for (const PlacedPart& p : unit)
              if (!in_unit) thickness += ask.thickness(p, q, d);
          }
          EXPECT_EQ(along.thickness(unit), thickness);
          EXPECT_NEAR(along.length(unit), std::max(0.0, ahead + behind), 1e-12);
        }
      }
      if (!moves && group.size() < n) {
        EXPECT_EQ(asked, before) << "nothing is new";
      }
      group.erase(group.begin() + static_cast<std::ptrdiff_t>(rng.below(group.size())));
    }
  }
}

/// Data cached while parts leave a group does not change the choice. When stopped, nothing is chosen.
TEST(ForcedMotions, AQuickMotionIsThatOfAGroupSeenAnew) {
  Rng rng(11);
  RunContext stopped;
  stopped.cancel.cancel();
  const Constraints none;
  for (int trial = 0; trial < 8; ++trial) {
    std::vector<std::pair<std::string, std::vector<fake::Box>>> parts;
    Placed group;
    for (PartId k = 0; k < 8; ++k) {
      const Vec3 lo(2.1 * (k % 2), 2.1 * (k / 2 % 2), 2.1 * (k / 4));
      parts.push_back({"p" + std::to_string(k), {{lo, lo + Vec3(rng.uniform(0.5, 2), rng.uniform(0.5, 2), 2)}}});
      group.push_back({k, Pose{}});
    }
    const Assembly assembly = fake::assembly_of(parts);
    const Verifier verifier(assembly, {});
    const PreparedAssembly nothing;
    const PlanningSetup setup = fake::setup(fake::push);
    const RunOptions options;
    RunContext context;
    const std::unique_ptr<PathOracle> oracle = make_oracle(assembly, nothing, setup, options, verifier, context);
    const LeastCutParameters params;
    ForcedMotions kept(assembly, *oracle, none, params);
    while (group.size() > 1) {
      ForcedMotions fresh(assembly, *oracle, none, params);
      EXPECT_FALSE(kept.quick_candidate(group, stopped));
      const auto a = kept.quick_candidate(group, {}), b = fresh.quick_candidate(group, {});
      ASSERT_TRUE(a && b);
      EXPECT_EQ(ids_of(a->moving), ids_of(b->moving));
      EXPECT_EQ(a->twist.linear, b->twist.linear);
      EXPECT_EQ(a->thickness, b->thickness);
      EXPECT_EQ(a->duration, b->duration);
      const PartId gone = a->moving.front().part;
      std::erase_if(group, [&](const PlacedPart& p) { return p.part == gone; });
    }
  }
}

}  // namespace
}  // namespace dismantle::least_cut
