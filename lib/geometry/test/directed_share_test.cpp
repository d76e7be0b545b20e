// Directed check with idle threads, which do not change its answer.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <numbers>

#include "dismantle/executor.h"
#include "dismantle/geometry/directed_check.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/testing/trials.h"

namespace dismantle::geometry {
namespace {

using shapes::Vec3;

Aabb grown(Aabb box, double by) {
  box.inflate(by);
  return box;
}

struct Outcome {
  Finding finding;
  bool by_shrunken_copy = false;
  Budget budget;
};

Outcome check(const Solid& a, const Solid& b, const std::vector<Pose>& path, const Limits& limits, Budget budget,
              unsigned threads) {
  RunContext context;
  if (threads > 1) context.executor = std::make_shared<Executor>(threads);
  budget.context = &context;
  std::vector<Pose> poses;
  for (const Pose& p : path) poses.push_back(p * a.frame);
  const RelativeMotion motion(poses, {b.frame}, grown(a.box, limits.most()));
  DirectedCheck directed(a, b, motion, limits, budget);
  Outcome o;
  o.finding = directed.run();
  o.by_shrunken_copy = directed.by_shrunken_copy();
  o.budget = budget;
  return o;
}

/// A rough peg in a sleeve of its size, moved straight, turned, or wound, with a full or a partial budget: the finding,
/// its place, and the budget spent.
TEST(DirectedShare, NobodyCanTellHowManyThreadsThereWere) {
  Rng rng(31);
  std::map<Answer, int> seen;
  const int trials = testing_support::trials(12, 60);
  for (int trial = 0; trial < trials; ++trial) {
    const double rough = trial % 4 < 2 ? 0.001 : trial % 4 == 2 ? rng.uniform(0.004, 0.012) : rng.uniform(0.01, 0.03);
    const double radius = 1 - (trial % 4 == 3 ? 0.2 : 1.0) * rough;
    Mesh peg = shapes::tube(0.3, radius, -1, 1, 40, 6);
    for (auto& v : peg.vertices) v += rough * shapes::random_vector(rng, -1, 1);
    const Solid a(peg), b(shapes::tube(1, 1.4, -1.2, 1.2, 56, 3, rng.uniform(0, 1)));
    std::vector<Pose> path{Pose{}};
    const int kind = trial % 3;
    const int instants = kind == 0 ? 1 : kind == 1 ? 3 : 12;
    for (int k = 1; k <= instants; ++k) {
      const double share = static_cast<double>(k) / instants;
      const double angle = kind == 0 ? 0 : (kind == 1 ? 0.5 : 6 * std::numbers::pi) * share;
      path.push_back({Vec3(0, 0, share), Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::UnitZ()))});
    }
    const Limits limits{0, 0.01};
    Budget all;
    all.tests_left = 200'000;
    all.patches_left = 20'000;
    const Outcome whole = check(a, b, path, limits, all, 1);
    for (const double share : {1.0, rng.uniform()}) {
      Budget budget = all;
      if (share < 1) {
        budget.tests_left = static_cast<std::uint64_t>(share * static_cast<double>(whole.budget.tests_done));
        budget.patches_left =
            static_cast<std::uint64_t>(share * static_cast<double>(all.patches_left - whole.budget.patches_left));
      }
      const Outcome alone = check(a, b, path, limits, budget, 1);
      ++seen[alone.finding.answer];
      for (const unsigned threads : {2U, 4U}) {
        const Outcome helped = check(a, b, path, limits, budget, threads);
        ASSERT_EQ(helped.finding.answer, alone.finding.answer) << trial;
        EXPECT_EQ(helped.finding.point, alone.finding.point) << trial;
        EXPECT_EQ(helped.finding.depth, alone.finding.depth) << trial;
        EXPECT_EQ(helped.finding.time, alone.finding.time) << trial;
        EXPECT_EQ(helped.budget.tests_done, alone.budget.tests_done) << trial;
        EXPECT_EQ(helped.budget.tests_left, alone.budget.tests_left) << trial;
        EXPECT_EQ(helped.budget.patches_left, alone.budget.patches_left) << trial;
        if (alone.finding.answer == Answer::certified) {
          EXPECT_EQ(helped.by_shrunken_copy, alone.by_shrunken_copy) << trial;
        }
      }
    }
  }
  for (const Answer answer : {Answer::certified, Answer::violated, Answer::exhausted})
    EXPECT_GT(seen[answer], trials / 6) << static_cast<int>(answer);
}

}  // namespace
}  // namespace dismantle::geometry
