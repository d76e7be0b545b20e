// Good plans of the samples with one pose changed at random: none that goes deeper than the tolerance by a tenth may pass.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include "brute_force.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/testing/trials.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle::trust {
namespace {

constexpr double kTolerance = 0.01;
constexpr std::size_t kMostTriangles = 1000;  // of an assembly: brute force takes the square of it

/// A step of a sample's truth as a plan of its own, of the parts that are there then.
struct OneStep {
  std::string name;
  Assembly assembly;
  Plan plan;
};

/// Few flat faces for round surfaces: brute force is slow.
samples::Model coarse_model(const samples::Sample& sample) {
  for (const ParamSpec& param : sample.params)
    if (param.name == "segments") return samples::make_model(sample.name, {{"segments", std::int64_t{24}}});
  return samples::make_model(sample.name);
}

/// Displacements of one part along a motion, dense enough for the rule of 1 % of the size from pose to pose, on top of `before`.
void append_poses(const samples::Screw& screw, double size, const Pose& before, std::vector<Pose>& poses) {
  const double travel = std::abs(screw.advance) + 2 * size * std::abs(screw.angle);
  const int count = std::max(2, static_cast<int>(std::ceil(travel / (0.008 * size))));
  for (int i = poses.empty() ? 0 : 1; i <= count; ++i) poses.push_back(screw.at(static_cast<double>(i) / count) * before);
}

/// The removals of single parts that make up a sample's truth, in its order.
std::vector<OneStep> steps_of(const samples::Sample& sample) {
  std::vector<OneStep> out;
  if (!sample.clean) return out;
  const samples::Model model = coarse_model(sample);
  std::size_t triangles = 0;
  for (const RawPart& part : model.parts) triangles += part.mesh.triangles.size();
  if (triangles > kMostTriangles) return out;
  std::vector<RawPart> there = model.parts;
  std::string moving;
  std::vector<samples::Screw> motions;
  for (const samples::TruthStep& truth : model.truth.steps) {
    const samples::TruthMotion& motion = truth.motions.front();
    if (truth.motions.size() != 1 || (!motions.empty() && motion.part != moving)) break;
    moving = motion.part;
    motions.push_back(motion.screw);
    if (truth.out.empty()) continue;
    if (truth.out != moving) break;
    PrepareOptions options;
    options.subdivide = 0;
    RunContext context;
    PrepareReport report;
    OneStep one{sample.name, prepare_assembly(there, sample.name, "", options, context, report), {}};
    const double size = 10 / one.assembly.normalization.scale;
    PlanStep step;
    step.step = 1;
    step.moves.push_back({moving, {}});
    for (const samples::Screw& screw : std::exchange(motions, {})) {
      std::vector<Pose>& poses = step.moves[0].poses;
      append_poses(screw, size, poses.empty() ? Pose{} : poses.back(), poses);
    }
    step.separates = {{moving}};
    one.plan.status = there.size() == 2 ? PlanStatus::complete : PlanStatus::partial;
    one.plan.verified_max_penetration = kTolerance;
    for (const Part& part : one.assembly.parts) {
      one.plan.assembly.parts.push_back({part.id, part.name, part.file});
      if (part.name != moving) one.plan.remaining.push_back(part.name);
    }
    one.plan.disassembly = {step};
    out.push_back(std::move(one));
    std::erase_if(there, [&](const RawPart& part) { return part.name == moving; });
    if (there.size() < 2) break;
  }
  return out;
}

const std::vector<OneStep>& good_steps() {
  static const std::vector<OneStep> all = [] {
    std::vector<OneStep> found;
    for (const auto& sample : samples::list())
      for (OneStep& step : steps_of(sample)) found.push_back(std::move(step));
    return found;
  }();
  return all;
}

PlanCheck check(const OneStep& one, const Plan& plan) {
  RunContext context;
  return check_plan(plan, one.assembly, {kTolerance}, context);
}

/// The deepest that a step goes near pose `k`, beyond what the pair overlaps when assembled; a lower bound.
double depth_near(const OneStep& one, const std::vector<Pose>& poses, std::size_t k) {
  const PlanMove& move = one.plan.disassembly[0].moves[0];
  const auto mover = std::find_if(one.assembly.parts.begin(), one.assembly.parts.end(),
                                  [&](const Part& p) { return p.name == move.part; });
  constexpr int kInstants = 4;  // of each segment
  const double spacing = 0.5;
  const std::vector<Vec3> own = surface_points(*mover->mesh, spacing);
  double worst = 0;
  for (std::size_t s = k > 0 ? k - 1 : 0; s < std::min(k + 1, poses.size() - 1); ++s)
    for (int i = 0; i <= kInstants; ++i) {
      const Pose a = one.assembly.normalization.pose_to_internal(poses[s]),
                 b = one.assembly.normalization.pose_to_internal(poses[s + 1]);
      const Pose at = screw_interpolate(a, b, static_cast<double>(i) / kInstants);
      for (const Part& other : one.assembly.parts) {
        if (other.id == mover->id) continue;
        const double allowed = one.assembly.initial_overlap(mover->id, other.id);
        worst = std::max({worst, deepest_of(own, at, *other.mesh) - allowed,
                          deepest_of(surface_points(*other.mesh, spacing), at.inverse(), *mover->mesh) - allowed});
      }
    }
  return worst;
}

TEST(MutatedPlans, TheGoodOnesAreGood) {
  EXPECT_GT(good_steps().size(), 5U);
  for (const OneStep& one : good_steps()) {
    const PlanCheck result = check(one, one.plan);
    EXPECT_TRUE(result.valid) << one.name << ": " << (result.problems.empty() ? "" : result.problems[0].message);
  }
}

TEST(MutatedPlans, NoneThatGoesTooDeepPasses) {
  Rng rng(29);
  const int trials = testing_support::trials(120, 100'000);
  int passed = 0, refused = 0, unexplained = 0;
  double deepest = 0;
  for (int trial = 0; trial < trials; ++trial) {
    if (testing_support::nightly() && trial % 1000 == 0 && trial > 0)
      std::cout << trial << " plans mutated: " << passed << " passed, the deepest by " << deepest << std::endl;
    const OneStep& one = good_steps()[static_cast<std::size_t>(trial) % good_steps().size()];
    Plan plan = one.plan;
    auto& poses = plan.disassembly[0].moves[0].poses;
    const std::size_t k = rng.below(poses.size());
    // From far below the tolerance to a jump, as lengths of assembly units.
    const double by = std::pow(10.0, rng.uniform(-4, 0)) / one.assembly.normalization.scale;
    Pose& pose = poses[k];
    if (rng.below(2) == 0) {
      pose.t += by * shapes::random_vector(rng, -1, 1).normalized();
    } else {
      const Vec3 axis = shapes::random_vector(rng, -1, 1).normalized();
      const Vec3 about = one.assembly.input_box.center();
      const Eigen::Quaterniond q(Eigen::AngleAxisd(by / one.assembly.input_box.size().maxCoeff(), axis));
      pose = Pose{about - q * about, q} * pose;
    }
    const PlanCheck result = check(one, plan);
    if (!result.valid) {
      ++refused;
      unexplained += result.problems.empty() ? 1 : 0;
      continue;
    }
    ++passed;
    const double depth = depth_near(one, poses, k);
    deepest = std::max(deepest, depth);
    ASSERT_LE(depth, 1.1 * kTolerance) << one.name << ", trial " << trial << ", pose " << k;
  }
  EXPECT_EQ(unexplained, 0);
  EXPECT_GT(passed, trials / 20);
  EXPECT_GT(refused, trials / 4);
  std::cout << trials << " plans mutated: " << passed << " passed, the deepest by " << deepest << "; " << refused
            << " refused\n";
}

}  // namespace
}  // namespace dismantle::trust
