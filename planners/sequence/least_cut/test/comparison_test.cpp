// Which step is forced: the sum of the depths to the end against brute force over all parts, groups and axes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/testing/held_shapes.h"
#include "dismantle/testing/trials.h"
#include "dismantle/verification/check_plan.h"
#include "dismantle/verification/motion_depth.h"
#include "last_resort.h"

namespace dismantle {
namespace {

using Eigen::Vector3d;

constexpr int kAround = 4;  // corners of round parts: depths of many faces take long to measure

struct Sum {
  double depth = 0;
  unsigned steps = 0;
};

/// The least sum of depths of straight motions along the coordinate axes that take all parts apart.
class BruteForce {
 public:
  explicit BruteForce(const Assembly& assembly)
      : assembly_(assembly), verifier_(assembly, {}), meter_(assembly, verifier_), known_(1U << assembly.parts.size()) {
    const std::size_t n = assembly.parts.size();
    depth_.assign(n * n, {});
    for (PartId p = 1; p < n; ++p)
      for (PartId q = 0; q < p; ++q)
        for (std::size_t d = 0; d < 6; ++d)  // the other one moves the other way
          depth_[p * n + q][d] = depth_[q * n + p][d % 2 == 0 ? d + 1 : d - 1] = measured(p, q, d);
  }
  Sum least() { return least((1U << assembly_.parts.size()) - 1); }

 private:
  double measured(PartId p, PartId q, std::size_t d) {
    const double sign = d % 2 == 0 ? 1 : -1;
    const Vector3d displacement = 30 * sign * Vector3d::Unit(static_cast<Eigen::Index>(d / 2));
    RunContext context;
    const MotionDepthOptions options{.absolute = 0.03, .relative = 0.03, .stop_above = 0.6, .most_poses = 300};
    const auto found = meter_.deepest({p}, {{q, Pose{}}}, {{Pose{}}, {shapes::shift(displacement)}}, options, context);
    return found ? found->excess() : 0;
  }
  Sum least(unsigned set) {
    if ((set & (set - 1)) == 0) return {};
    if (known_[set].second) return known_[set].first;
    const std::size_t n = assembly_.parts.size();
    Sum best{std::numeric_limits<double>::infinity(), 0};
    for (unsigned moving = (set - 1) & set; moving > 0; moving = (moving - 1) & set)
      for (std::size_t d = 0; d < 6; ++d) {
        double excess = 0;
        for (PartId p = 0; p < n; ++p)
          for (PartId q = 0; q < n; ++q)
            if ((moving >> p & 1U) != 0 && ((set & ~moving) >> q & 1U) != 0)
              excess = std::max(excess, depth_[p * n + q][d]);
        if (excess >= best.depth) continue;
        const Sum a = least(moving), b = least(set & ~moving);
        const bool forced = excess > verifier_.options().max_penetration;
        const Sum sum{(forced ? excess : 0) + a.depth + b.depth, (forced ? 1U : 0U) + a.steps + b.steps};
        if (sum.depth < best.depth || (sum.depth == best.depth && sum.steps < best.steps)) best = sum;
      }
    known_[set] = {best, true};
    return best;
  }

  const Assembly& assembly_;
  Verifier verifier_;
  MotionDepthMeter meter_;
  std::vector<std::array<double, 6>> depth_;
  std::vector<std::pair<Sum, bool>> known_;
};

/// A bar about z with a narrow bore, and heads of radius `head` of height 0.6 that begin at these heights.
Mesh bar_with_heads(double radius, double head, const std::vector<double>& heads, double end) {
  std::vector<std::pair<double, double>> outline{{0.05, -0.5}, {radius, -0.5}};
  for (const double z : heads)
    for (const auto& [r, dz] : {std::pair{radius, 0.0}, {head, 0.0}, {head, 0.6}, {radius, 0.6}})
      outline.emplace_back(r, z + dz);
  outline.insert(outline.end(), {{radius, end}, {0.05, end}});
  return shapes::lathe(outline, kAround);
}

/// A rod with collars on both sides of each of two eyes, at night three, which are too narrow for them.
Assembly rod_through_eyes(Rng& rng) {
  const double rod = rng.uniform(0.5, 0.8), hole = rod + 0.05, collar = hole + rng.uniform(0.1, 0.3);
  const int eyes = testing_support::nightly() ? 3 : 2;
  std::vector<double> heads;
  std::vector<Mesh> parts{{}};
  for (int k = 0; k < eyes; ++k) {
    heads.insert(heads.end(), {3.0 * k, 3.0 * k + 2});
    parts.push_back(shapes::tube(hole, hole + rng.uniform(0.15, 1.5), 3 * k + 0.7, 3 * k + 1.9, kAround));
  }
  parts.front() = bar_with_heads(rod, collar, heads, 3 * eyes);
  return shapes::assembly_of(parts);
}

/// Two bars with heads at both ends, joined by a beam, and a ring around each.
Assembly two_rings(Rng& rng) {
  Mesh frame = fake::boxes({{{-4, -0.5, -1.5}, {4, 0.5, -0.52}}});
  std::vector<Mesh> rings;
  for (const double x : {-3.0, 3.0}) {
    const double bar = rng.uniform(0.3, 0.5), hole = bar + 0.1, head = hole + rng.uniform(0.1, 0.5);
    shapes::append(frame, shapes::moved(bar_with_heads(bar, head, {0, 2.5}, 3.5), shapes::shift({x, 0, 0})));
    rings.push_back(shapes::moved(shapes::tube(hole, hole + rng.uniform(0.2, 1), 0.7, rng.uniform(1.2, 2.4), kAround),
                                  shapes::shift({x, 0, 0})));
  }
  return shapes::assembly_of({frame, rings[0], rings[1]});
}

/// A spacer and a filler beside it between two plates with a wall on one side and lips on the three others.
Assembly spacer_between_plates(Rng& rng) {
  const auto lip = [&] { return rng.uniform(0.1, 0.9); };
  const std::vector<fake::Box> housing{{{-0.5, -0.5, -0.5}, {6.5, 4.5, -0.02}}, {{-0.5, -0.5, 2.02}, {6.5, 4.5, 2.5}},
                                       {{-0.5, -0.5, 0}, {-0.1, 4.5, 2}},       {{6.1, 0, 0}, {6.5, 4, lip()}},
                                       {{0, -0.5, 0}, {6, -0.1, lip()}},        {{0, 4.1, 0}, {6, 4.5, lip()}}};
  const double border = rng.uniform(1.5, 4);
  return fake::assembly_of({{"housing", housing},
                            {"filler", {{{0, 0, 0}, {border, 4, rng.uniform(1, 1.9)}}}},
                            {"spacer", {{{border + 0.1, 0, 0}, {6, 4, rng.uniform(1, 1.9)}}}}});
}

/// A box with a cover that four hooks hold, and a block inside.
Assembly cover_with_snaps(Rng& rng) {
  std::vector<fake::Box> base{{{0, 0, -0.5}, {6, 6, -0.02}},
                              {{0, 0, 0}, {0.5, 6, 2}},
                              {{5.5, 0, 0}, {6, 6, 2}},
                              {{0.52, 0, 0}, {5.48, 0.5, 2}},
                              {{0.52, 5.5, 0}, {5.48, 6, 2}}};
  std::vector<fake::Box> cover{{{0, 0, 2.02}, {6, 6, 2.5}}, {{0, -0.5, 1}, {6, -0.02, 2}}, {{0, 6.02, 1}, {6, 6.5, 2}}};
  for (const double y : {1.0, 4.0}) {
    const double bite = rng.uniform(0.05, 0.3);
    base.push_back({{-bite, y, 1}, {-0.005, y + 1, 1.5}});
    base.push_back({{6.005, y, 1}, {6 + bite, y + 1, 1.5}});
    for (const bool right : {false, true}) {
      const double out = right ? 6.35 : -0.35, end = right ? 6.6 : -0.6, in = right ? 6.02 : -0.02;
      cover.push_back({{std::min(out, end), y, 0.4}, {std::max(out, end), y + 1, 2.3}});
      cover.push_back({{std::min(in, out), y, 0.4}, {std::max(in, out), y + 1, 0.95}});
      cover.push_back({{std::min(in, end), y, 2.32}, {std::max(in, end), y + 1, 2.5}});
    }
  }
  return fake::assembly_of({{"base", base}, {"cover", cover}, {"block", {{{1, 1, 0.1}, {5, 5, 1.9}}}}});
}

/// A screw with a neck below its head, deep in its bore along the thread and deeper in the narrower mouth of the bore.
Assembly screw_with_neck(Rng& rng) {
  const double shank = rng.uniform(2, 4), length = rng.uniform(3, 5) * shank, mouth = rng.uniform(0.8, 1.5) * shank;
  const double bore = shank - rng.uniform(0.2, 0.3), narrow = bore - rng.uniform(0.1, 0.2), neck = narrow - 0.2;
  const Mesh screw = shapes::lathe({{0.05, -length},
                                    {shank, -length},
                                    {shank, -1.5 * mouth},
                                    {neck, -1.5 * mouth},
                                    {neck, 0},
                                    {2 * shank, 0},
                                    {2 * shank, shank},
                                    {0.05, shank}},
                                   kAround);
  const Mesh block = shapes::lathe(
      {{bore, -length - 2}, {3 * shank, -length - 2}, {3 * shank, 0}, {narrow, 0}, {narrow, -mouth}, {bore, -mouth}},
      kAround);
  return shapes::assembly_of({block, screw}, {{0, 1, (shank - bore) * std::cos(std::numbers::pi / kAround)}});
}

void expect_the_least_sum(const Assembly& assembly) {
  const auto nothing = [](const Assembly&, PathOracle&, SequenceObserver&, RunContext&) {
    SequenceResult result;
    result.outcome = Outcome::exhausted;
    return result;
  };
  const Plan plan = fake::forced_run(assembly, std::make_shared<fake::Custom>(nothing)).plan;
  ASSERT_EQ(plan.status, PlanStatus::forced);
  RunContext context;
  const PlanCheck checked = check_plan(plan, assembly, VerifyOptions{}, context);
  EXPECT_TRUE(checked.valid) << (checked.problems.empty() ? "" : checked.problems.front().message);
  double sum = 0;
  for (const PlanStep& step : plan.disassembly)
    if (step.forced) sum += step.forced->depth - step.forced->assembled;
  const Sum least = BruteForce(assembly).least();
  const double resolution = plan.forced_steps() * VerifyOptions{}.max_penetration;
  const bool fewer = plan.forced_steps() < least.steps;  // for that the sum may be a tenth more
  EXPECT_LE(sum, (fewer ? 1.15 : 1.05) * least.depth + resolution);
  EXPECT_LE(plan.forced_steps(), least.steps);
}

/// A ball in a closed box: the middle of the ball passes the thin wall, at one point of the surface and of the way.
/// Where that is less than a tenth of the tolerance, to this.
TEST(ForcedDepth, IsStatedToAHundredth) {
  Rng rng(7);
  for (int k = 0; k < testing_support::trials(8, 80); ++k) {
    const double size = k % 2 == 0 ? 1 : 4 * VerifyOptions{}.max_penetration;
    const double radius = size * rng.uniform(0.5, 1.5), wall = rng.uniform(0.05, 0.3) * radius;
    const Pose world = shapes::random_pose(rng, 2);
    const Mesh ball = shapes::moved(shapes::sphere(shapes::random_vector(rng, -0.4, 0.4), radius, 2), world);
    const double exact = 0.1 * VerifyOptions{}.max_penetration;
    const Assembly assembly = shapes::assembly_of(
        {ball, shapes::moved(shapes::closed_box(Vector3d::Constant(-2), Vector3d::Constant(2), wall), world)});
    Vector3d center = Vector3d::Zero();
    for (const Vector3d& v : ball.vertices) center += v / static_cast<double>(ball.vertices.size());
    const double middle = -TriangleBvh(ball).signed_distance(center);
    const auto nothing = [](const Assembly&, PathOracle&, SequenceObserver&, RunContext&) {
      SequenceResult result;
      result.outcome = Outcome::exhausted;
      return result;
    };
    const Plan plan = fake::forced_run(assembly, std::make_shared<fake::Custom>(nothing)).plan;
    ASSERT_EQ(plan.forced_steps(), 1U);
    EXPECT_NEAR(plan.disassembly.front().forced->depth, middle, std::max(exact, 0.01 * middle)) << "trial " << k;
  }
}

struct Kind {
  const char* name;
  Assembly (*make)(Rng&);
};

class ForcedSum : public testing::TestWithParam<Kind> {};

TEST_P(ForcedSum, IsTheLeastOverAllPartsGroupsAndAxes) {
  const int cases = testing_support::trials(1, 10);
  for (int k = 0; k < cases; ++k) {
    SCOPED_TRACE(k);
    Rng rng(static_cast<std::uint64_t>(k));
    expect_the_least_sum(GetParam().make(rng));
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ForcedSum,
                         testing::Values(Kind{"rod", rod_through_eyes}, Kind{"rings", two_rings},
                                         Kind{"spacer", spacer_between_plates}, Kind{"snaps", cover_with_snaps},
                                         Kind{"neck", screw_with_neck}),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace dismantle
