// Motions that are drawn with fewer poses are the same motions.
#include "steps/fewer_poses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dismantle/run_context.h"

namespace dismantle {
namespace {

Eigen::Vector3d random_vector(Rng& rng, double size) {
  return size * Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
}

/// Stretches, straight or with turns, in which each part has a speed of its own.
PlanStep random_step(Rng& rng) {
  PlanStep step;
  step.moves.resize(1 + rng.below(3));
  std::vector<Pose> now(step.moves.size());
  for (std::size_t m = 0; m < now.size(); ++m) {
    now[m] = {random_vector(rng, 300),
              Eigen::Quaterniond(Eigen::AngleAxisd(rng.uniform(0, 3), Eigen::Vector3d::UnitX()))};
    step.moves[m].poses.push_back(now[m]);
  }
  for (std::size_t stretch = 1 + rng.below(4); stretch > 0; --stretch) {
    const std::size_t count = 1 + rng.below(60);
    const bool turns = rng.below(4) == 0, waits = rng.below(8) == 0;
    std::vector<Eigen::Vector3d> speeds;
    for (std::size_t m = 0; m < now.size(); ++m) speeds.push_back(random_vector(rng, waits ? 0 : 3));
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t m = 0; m < now.size(); ++m) {
        now[m].t += speeds[m];
        if (turns) now[m].q = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()) * now[m].q;
        step.moves[m].poses.push_back(now[m]);
      }
  }
  step.transfer = rng.below(step.moves.front().poses.size());
  return step;
}

TEST(FewerPoses, TheMotionIsTheSame) {
  Rng rng(3);
  std::size_t before = 0, after = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const PlanStep step = random_step(rng);
    PlanStep fewer = step;
    const std::vector<std::size_t> numbers = leave_out_poses(fewer);
    const std::size_t n = step.moves.front().poses.size(), few = fewer.moves.front().poses.size();
    before += n;
    after += few;
    for (std::size_t m = 0; m < step.moves.size(); ++m) {
      const std::vector<Pose>&all = step.moves[m].poses, &kept = fewer.moves[m].poses;
      ASSERT_EQ(kept.size(), few);
      EXPECT_EQ(all[step.transfer], kept.at(fewer.transfer)) << trial;
      EXPECT_EQ(all.front(), kept.front());
      EXPECT_EQ(all.back(), kept.back());
    }
    ASSERT_EQ(numbers.size(), few);
    // Poses that are left out lie between those that are kept, of all parts at equal distances.
    for (std::size_t i = 0; i < few; ++i)
      for (std::size_t m = 0; m < step.moves.size(); ++m) {
        const std::vector<Pose>& all = step.moves[m].poses;
        const Pose& a = all[numbers[i]];
        EXPECT_EQ(a, fewer.moves[m].poses[i]) << trial;
        if (i + 1 == few) continue;
        const Pose& b = all[numbers[i + 1]];
        for (std::size_t k = numbers[i] + 1; k < numbers[i + 1]; ++k) {
          const double share = static_cast<double>(k - numbers[i]) / static_cast<double>(numbers[i + 1] - numbers[i]);
          EXPECT_LT((all[k].t - a.t - share * (b.t - a.t)).norm(), 1e-5) << trial;
          EXPECT_EQ(all[k].q.coeffs(), a.q.coeffs()) << trial;
        }
      }
  }
  EXPECT_LT(2 * after, before);
}

TEST(FewerPoses, AForcedStepKeepsAll) {
  Rng rng(4);
  PlanStep step = random_step(rng);
  step.forced = PlanForced{};
  PlanStep same = step;
  EXPECT_EQ(leave_out_poses(same).size(), step.moves.front().poses.size());
  EXPECT_EQ(same.moves.front().poses.size(), step.moves.front().poses.size());
}

}  // namespace
}  // namespace dismantle
