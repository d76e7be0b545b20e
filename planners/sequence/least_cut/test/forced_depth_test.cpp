// The depth that a forced step states, against brute force: points all over the faces, at many instants.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/testing/trials.h"
#include "dismantle/verification/check_plan.h"
#include "last_resort.h"

namespace dismantle {
namespace {

using Eigen::Vector3d;
using fake::Box;
using NamedBoxes = std::vector<std::pair<std::string, std::vector<Box>>>;

/// Six walls around the space from `lo` to `hi`, each with its own thickness.
std::vector<Box> cage(Rng& rng, const Vector3d& lo, const Vector3d& hi) {
  std::vector<Box> walls;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      Box wall{lo - Vector3d::Constant(0.05), hi + Vector3d::Constant(0.05)};
      const double thickness = rng.uniform(0.1, 0.8);
      (upper ? wall.lo : wall.hi)[axis] = upper ? hi[axis] : lo[axis];
      (upper ? wall.hi : wall.lo)[axis] = upper ? hi[axis] + thickness : lo[axis] - thickness;
      walls.push_back(wall);
    }
  return walls;
}

/// A cage with one or two blocks side by side inside, which touch nothing.
NamedBoxes blocks_in_a_cage(Rng& rng) {
  NamedBoxes parts;
  Vector3d lo = Vector3d::Zero(), hi = lo;
  const std::size_t blocks = 1 + rng.below(2);
  for (std::size_t k = 0; k < blocks; ++k) {
    const Vector3d size(rng.uniform(0.2, 1.5), rng.uniform(0.2, 1.5), rng.uniform(0.2, 1.5));
    const Vector3d from(hi.x() + 0.1, rng.uniform(0, 0.3), rng.uniform(0, 0.3));
    parts.push_back({"block" + std::to_string(k), {{from, from + size}}});
    hi = hi.cwiseMax(from + size);
  }
  parts.insert(parts.begin(), {"cage", cage(rng, lo, hi + Vector3d::Constant(0.1))});
  return parts;
}

/// Depth of a point in a box: zero outside.
double depth_in(const Vector3d& x, const Box& box) {
  return std::max(0.0, std::min((x - box.lo).minCoeff(), (box.hi - x).minCoeff()));
}

/// The largest depth in `in` of points on the faces of `of`, moved by `shift`.
double deepest(const Box& of, const Vector3d& shift, const Box& in) {
  constexpr int kPoints = 24;  // along an edge
  double most = 0;
  if (!Aabb{of.lo + shift, of.hi + shift}.overlaps({in.lo, in.hi})) return most;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true})
      for (int i = 0; i <= kPoints; ++i)
        for (int k = 0; k <= kPoints; ++k) {
          Vector3d share;
          share[axis] = upper ? 1 : 0;
          share[(axis + 1) % 3] = static_cast<double>(i) / kPoints;
          share[(axis + 2) % 3] = static_cast<double>(k) / kPoints;
          most = std::max(most, depth_in(of.lo + share.cwiseProduct(of.hi - of.lo) + shift, in));
        }
  return most;
}

/// The same for both parts over a whole step, in which parts move in straight lines from pose to pose without rotation.
double brute_force(const PlanStep& step, const NamedBoxes& parts, const std::map<std::string, Vector3d>& others) {
  constexpr int kInstants = 8;  // from pose to pose
  double most = 0;
  const auto boxes_of = [&](const std::string& name) -> const std::vector<Box>& {
    return std::find_if(parts.begin(), parts.end(), [&](const auto& p) { return p.first == name; })->second;
  };
  for (const PlanMove& move : step.moves)
    for (std::size_t i = 0; i + 1 < move.poses.size(); ++i)
      for (int k = 0; k <= kInstants; ++k) {
        const Vector3d at = move.poses[i].t + (move.poses[i + 1].t - move.poses[i].t) * k / kInstants;
        for (const auto& [name, stays] : others)
          for (const Box& a : boxes_of(move.part))
            for (const Box& b : boxes_of(name))
              most = std::max({most, deepest(a, at - stays, b), deepest(b, stays - at, a)});
      }
  return most;
}

/// Gives up immediately.
std::shared_ptr<SequencePlanner> gives_up() {
  return std::make_shared<fake::Custom>([](const Assembly& a, PathOracle&, SequenceObserver&, RunContext&) {
    SequenceResult result;
    result.outcome = Outcome::exhausted;
    for (const Part& p : a.parts) result.remaining.push_back(p.id);
    return result;
  });
}

RunResult forced_run(const Assembly& assembly, RunContext context) {
  return fake::forced_run(assembly, gives_up(), std::move(context));
}

TEST(ForcedDepth, AgreesWithBruteForceToATenth) {
  Rng rng(41);
  unsigned forced = 0;
  const int trials = testing_support::trials(12, 60);
  for (int trial = 0; trial < trials; ++trial) {
    const NamedBoxes parts = blocks_in_a_cage(rng);
    const Assembly assembly = fake::assembly_of(parts);
    const RunResult r = forced_run(assembly, {});
    ASSERT_EQ(r.plan.status, PlanStatus::forced) << "trial " << trial;
    std::map<std::string, Vector3d> left;
    for (const auto& p : parts) left[p.first] = Vector3d::Zero();
    for (const PlanStep& step : r.plan.disassembly) {
      for (const PlanMove& move : step.moves) {
        left.erase(move.part);
        for (const Pose& pose : move.poses) ASSERT_LT(angle_between(pose.q, Pose{}.q), 1e-9);
      }
      const double brute = brute_force(step, parts, left);
      if (!step.forced) {
        EXPECT_LT(brute, 0.011) << "trial " << trial;
        continue;
      }
      ++forced;
      EXPECT_NEAR(step.forced->depth, brute, 0.1 * brute) << "trial " << trial;
    }
  }
  EXPECT_GE(forced, static_cast<unsigned>(trials));
}

TEST(ForcedDepth, WithoutTimeThereIsAWholeAnswerAllTheSame) {
  Rng rng(43);
  for (int trial = 0; trial < 12; ++trial) {
    NamedBoxes parts = blocks_in_a_cage(rng);
    const std::size_t free = rng.below(4);
    for (std::size_t k = 0; k < free; ++k) {
      const Vector3d at(10 + 2.0 * static_cast<double>(k), 0, 0);
      parts.push_back({"free" + std::to_string(k), {{at, at + Vector3d::Ones()}}});
    }
    const Assembly assembly = fake::assembly_of(parts);
    RunContext context;
    context.deadline = Deadline::after_seconds(0);
    // What quick steps take depends on the machine: the time that they may take is no part of this test.
    const RunResult r = fake::forced_run(assembly, gives_up(), context, {}, {.overtime = 3600});
    EXPECT_EQ(r.plan.status, PlanStatus::forced) << "trial " << trial;
    EXPECT_EQ(r.plan.disassembly.size(), parts.size() - 1);
    EXPECT_TRUE(r.plan.unsolved.empty());
    for (const PlanStep& step : r.plan.disassembly) EXPECT_FALSE(step.forced && step.forced->reason.empty());
  }
}

TEST(ForcedDepth, ALowerBoundThatIsTooDeepIsRefused) {
  Rng rng(47);
  for (int trial = 0; trial < 4; ++trial) {
    const Assembly assembly = fake::assembly_of(blocks_in_a_cage(rng));
    Plan plan = forced_run(assembly, {}).plan;
    const auto valid = [&] {
      RunContext checking;
      return check_plan(plan, assembly, VerifyOptions{}, checking).valid;
    };
    auto step = std::find_if(plan.disassembly.begin(), plan.disassembly.end(), [](const auto& s) { return s.forced; });
    ASSERT_NE(step, plan.disassembly.end());
    const double depth = step->forced->depth;
    step->forced->depth = 0.5 * depth;
    EXPECT_FALSE(valid());
    step->forced->lower_bound = true;
    EXPECT_TRUE(valid());
    step->forced->depth = 1.5 * depth;
    EXPECT_FALSE(valid());
  }
}

/// The planner gives up, but a straight motion that is valid is not forced.
TEST(ForcedDepth, AStraightMotionThatIsValidIsVerified) {
  for (const unsigned n : {2u, 5u}) {
    const RunResult r = forced_run(fake::row(n), {});
    EXPECT_EQ(r.plan.status, PlanStatus::complete);
    EXPECT_EQ(r.outcome, Outcome::solved);
    EXPECT_EQ(r.plan.forced_steps(), 0u);
    EXPECT_EQ(r.plan.disassembly.size(), n - 1);
  }
}

}  // namespace
}  // namespace dismantle
