// The planner on boxes with known answers, with a path planner that never finds anything.
#include "blocking/blocking.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/plan_io/plan_file.h"
#include "dismantle/testing/barred_shaft.h"
#include "run_blocking.h"

namespace dismantle {
namespace {

using fake::helpless;
using fake::take_apart;

/// Two combs that hold each other, in a tube that is open at the top: they can leave it only as one group.
Assembly combs_in_tube() {
  const auto hook = [](double s) {  // a stem, and two teeth, each between two of the other's
    std::vector<fake::Box> boxes{{{0.5, -0.9, 0.1}, {0.9, 0.9, 3.9}},
                                 {{-0.4, -0.9, s > 0 ? 0.1 : 1.1}, {0.5, 0.9, s > 0 ? 0.9 : 1.9}},
                                 {{-0.4, -0.9, s > 0 ? 2.1 : 3.1}, {0.5, 0.9, s > 0 ? 2.9 : 3.9}}};
    for (auto& b : boxes)
      if (s < 0) {
        const Eigen::Vector3d lo(-b.hi.x(), b.lo.y(), b.lo.z()), hi(-b.lo.x(), b.hi.y(), b.hi.z());
        b = {lo, hi};
      }
    return boxes;
  };
  return fake::assembly_of({{"tube",
                             {{{-2, -2, -1}, {2, 2, 0}},
                              {{-2, -2, 0}, {-1, 2, 4}},
                              {{1, -2, 0}, {2, 2, 4}},
                              {{-1, -2, 0}, {1, -1, 4}},
                              {{-1, 1, 0}, {1, 2, 4}}}},
                            {"left", hook(-1)},
                            {"right", hook(1)}});
}

TEST(Blocking, OneProposalPerPartWhereAllLeaveStraight) {
  for (const unsigned n : {1U, 3U, 8U}) {
    const RunResult r = take_apart(fake::tube_with_blocks(n));
    EXPECT_EQ(r.outcome, Outcome::solved);
    EXPECT_EQ(r.counts.attempts, 0u);
    EXPECT_EQ(r.counts.proposed, n);
    EXPECT_EQ(r.counts.refused, 0u);
    for (unsigned k = 0; k < n; ++k) EXPECT_EQ(r.plan.disassembly[k].separates[0][0], "block" + std::to_string(n - k));
  }
}

TEST(Blocking, StepsThatNeedNotWaitShareALayer) {
  const RunResult row = take_apart(fake::row(6));
  ASSERT_EQ(row.plan.disassembly.size(), 5u);
  for (const PlanStep& step : row.plan.disassembly) EXPECT_EQ(step.layer, 1u);
  const RunResult tube = take_apart(fake::tube_with_blocks(4));
  ASSERT_EQ(tube.plan.disassembly.size(), 4u);
  for (const PlanStep& step : tube.plan.disassembly) {
    EXPECT_EQ(step.layer, step.step);
    EXPECT_EQ(step.after, step.step == 1 ? std::vector<unsigned>{} : std::vector<unsigned>{step.step - 1});
  }
}

TEST(Blocking, UpwardsLeavesTheBaseToTheEnd) {
  // Piles of blocks on a small base that is listed first: every part can leave to all sides, once nothing is on it.
  Rng rng(3);
  for (int trial = 0; trial < 10; ++trial) {
    std::vector<std::pair<std::string, std::vector<fake::Box>>> parts{{"base", {{{0, 0, 0}, {0.5, 0.5, 0.5}}}}};
    const std::uint64_t n = 3 + rng.below(6);
    for (std::uint64_t k = 0; k < n; ++k) {
      const double x = rng.uniform(-0.8, 0.2), y = rng.uniform(-0.8, 0.2), z = 0.6 + 1.1 * static_cast<double>(k);
      parts.push_back({"block" + std::to_string(k), {{{x, y, z}, {x + 1, y + 1, z + 1}}}});
    }
    BlockingParameters params;
    params.upwards = blocking::Upwards::on;
    const RunResult r = take_apart(fake::assembly_of(parts), 1, {}, &helpless, {}, params);
    ASSERT_EQ(r.outcome, Outcome::solved);
    ASSERT_EQ(r.plan.disassembly.size(), n);
    for (std::uint64_t k = 0; k < n; ++k)
      EXPECT_EQ(r.plan.disassembly[k].separates[0][0], "block" + std::to_string(n - 1 - k));
  }
}

/// Towers of blocks on a plate, one beside the other. The name of a block is `tower`.`number from below`.
std::vector<std::pair<std::string, std::vector<fake::Box>>> towers(Rng& rng, std::map<std::string, double>& top) {
  std::vector<std::pair<std::string, std::vector<fake::Box>>> parts{{"plate", {{{0, 0, -1}, {20, 2, 0}}}}};
  for (int tower = 0; tower < 4; ++tower) {
    double z = 0.1;
    for (std::uint64_t k = 0, n = 2 + rng.below(4); k < n; ++k) {
      const double height = rng.uniform(0.5, 2), x = 5 * tower;
      const std::string name = std::to_string(tower) + "." + std::to_string(k);
      parts.push_back({name, {{{x, 0, z}, {x + 4, 2, z + height}}}});
      top[name] = z + height;
      z += height + 0.1;
    }
  }
  return parts;
}

TEST(Blocking, UpwardsTakesTheHighestFirstOfWhatPeopleBuildInSteps) {
  Rng rng(5);
  for (int trial = 0; trial < 5; ++trial) {
    std::map<std::string, double> top;
    Assembly assembly = fake::assembly_of(towers(rng, top));
    assembly.reference_order.push_back({1, {}, ""});
    for (const Part& part : assembly.parts) assembly.reference_order[0].parts.push_back(part.id);
    BlockingParameters params;
    params.upwards = blocking::Upwards::on;
    const RunResult r = take_apart(assembly, 1, {}, &helpless, {}, params);
    ASSERT_EQ(r.outcome, Outcome::solved);
    double last = std::numeric_limits<double>::infinity();
    for (const PlanStep& step : r.plan.disassembly) {
      ASSERT_EQ(step.separates[0].size(), 1u);
      EXPECT_LE(top.at(step.separates[0][0]), last);
      last = top.at(step.separates[0][0]);
    }
  }
}

/// What is more than half of the whole is what the others are put to, however high it is.
TEST(Blocking, UpwardsTakesTheSmallerOutOfTheLarger) {
  Rng rng(7);
  std::map<std::string, double> top;
  auto parts = towers(rng, top);
  const std::size_t small = parts.size() + 2;
  for (int k = 0; k < 2 * static_cast<int>(small); ++k)  // a tower that is higher than all others
    parts.push_back({"9." + std::to_string(k), {{{30, 0, 2.1 * k}, {34, 2, 2.1 * k + 2}}}});
  Assembly assembly = fake::assembly_of(parts);
  for (const Part& part : assembly.parts)
    assembly.reference_order.push_back({1, {part.id}, part.name.starts_with("9.") ? "large" : "small"});
  BlockingParameters params;
  params.upwards = blocking::Upwards::on;
  const RunResult r = take_apart(assembly, 1, {}, &helpless, {}, params);
  ASSERT_EQ(r.outcome, Outcome::solved);
  for (const std::string& name : r.plan.disassembly.front().separates[0])
    EXPECT_FALSE(name.starts_with("9.")) << "the large group is taken out whole";
}

TEST(Blocking, UpwardsTakesOutWholeWhatTheFileBuildsByItself) {
  Rng rng(6);
  for (int trial = 0; trial < 5; ++trial) {
    std::map<std::string, double> top;
    auto parts = towers(rng, top);
    parts.push_back({"roof", {{{10, 0, 15}, {14, 2, 16}}}});  // over a group: leaves first
    Assembly assembly = fake::assembly_of(parts);
    std::map<std::string, std::set<std::string>> groups;
    for (const Part& part : assembly.parts)
      for (const char* tower : {"1", "2"})
        if (part.name.starts_with(std::string(tower) + ".")) {
          groups[tower].insert(part.name);
          assembly.reference_order.push_back({1, {part.id}, tower});
        }
    BlockingParameters params;
    params.upwards = blocking::Upwards::on;
    const RunResult r = take_apart(assembly, 1, {}, &helpless, {}, params);
    ASSERT_EQ(r.outcome, Outcome::solved);
    std::set<std::string> whole, apart;
    for (const PlanStep& step : r.plan.disassembly) {
      const std::set<std::string> out(step.separates[0].begin(), step.separates[0].end());
      const std::string tower = out.begin()->substr(0, 1);
      if (out.size() > 1) {
        EXPECT_EQ(out, groups.at(tower));
        whole.insert(tower);
      } else if (groups.contains(tower)) {
        EXPECT_TRUE(whole.contains(tower)) << "a part left before its group";
        apart.insert(tower);
      }
    }
    EXPECT_EQ(whole.size(), 2u);
    EXPECT_EQ(apart.size(), 2u);
  }
}

TEST(Blocking, SaysWhatNeverComesOut) {
  const RunResult r = take_apart(fake::closed_box());
  EXPECT_EQ(r.outcome, Outcome::exhausted);
  EXPECT_TRUE(r.plan.disassembly.empty());
  ASSERT_EQ(r.plan.unsolved.size(), 2u);
  for (const auto& u : r.plan.unsolved) EXPECT_EQ(u.outcome, Outcome::exhausted);
}

TEST(Blocking, ShiftsWhatIsInTheWayAndLeavesItThere) {
  const RunResult r = take_apart(barred_shaft());
  ASSERT_EQ(r.plan.disassembly.size(), 2u);
  EXPECT_TRUE(r.plan.disassembly[0].separates.empty());
  EXPECT_EQ(r.plan.disassembly[0].moves[0].part, "bar");
  EXPECT_EQ(r.plan.disassembly[1].separates[0][0], "drawer");
  EXPECT_EQ(r.plan.disassembly[1].after, std::vector<unsigned>{1});
  EXPECT_EQ(r.plan.status, PlanStatus::partial) << "the bar never leaves";
  BlockingParameters no_slides;
  no_slides.translation_states = 0;
  RunContext context;
  const RunResult without =
      run(barred_shaft(), fake::setup(helpless, std::make_shared<Blocking>(no_slides)), RunOptions{}, context);
  EXPECT_TRUE(without.plan.disassembly.empty());
}

TEST(Blocking, TakesOutAGroupAndThenTakesItApart) {
  RunOptions options;
  options.constraints.base = {0};  // otherwise the tube is removed from the two
  const RunResult r = take_apart(combs_in_tube(), 1, options);
  EXPECT_EQ(r.outcome, Outcome::solved);
  ASSERT_GE(r.plan.disassembly.size(), 2u);
  EXPECT_EQ(r.plan.disassembly[0].separates[0].size(), 2u);
  EXPECT_EQ(r.plan.disassembly.back().separates[0].size(), 1u);
}

TEST(Blocking, SamePlanOnAnyNumberOfThreads) {
  for (const Assembly& assembly : {fake::tube_with_blocks(6), fake::row(7), barred_shaft(), combs_in_tube()}) {
    std::set<std::string> plans;
    std::set<double> relations;
    for (const unsigned threads : {1U, 2U, 3U}) {
      RunResult r = take_apart(assembly, threads);
      for (auto* steps : {&r.plan.disassembly, &r.plan.assembly_steps})
        for (PlanStep& step : *steps) step.seconds = 0;
      for (PlanUnsolved& u : r.plan.unsolved) u.seconds = 0;
      plans.insert(to_json(r.plan));
      relations.insert(r.sequence_counts.at("relations"));
    }
    EXPECT_EQ(plans.size(), 1u);
    EXPECT_EQ(relations.size(), 1u) << "what was computed ahead is not counted";
  }
}

/// Two rails side by side in a channel that is open at one end. Before it stands a latch, whose round shaft turns in a
/// hole of the roof and whose bar, `angle` rad from lying across, is in the way of both.
Assembly latched_rails(double angle, double length) {
  Assembly assembly = fake::assembly_of({{"channel",
                                          {{{-4, -2, -1}, {4, 2, 0}},
                                           {{-4, -2, 0.01}, {-3, 2, 1}},
                                           {{-2.99, -2, 0.01}, {4, -1, 1}},
                                           {{-2.99, 1, 0.01}, {4, 2, 1}},
                                           {{-4, -2, 1.05}, {0.8, 2, 2}},
                                           {{1.6, -2, 1.05}, {4, 2, 2}},
                                           {{0.81, -2, 1.05}, {1.59, -0.4, 2}},
                                           {{0.81, 0.4, 1.05}, {1.59, 2, 2}},
                                           {{-4, -2, 2.01}, {4, 2, 3}}}},
                                         {"left", {{{-2.9, -0.9, 0.1}, {0, -0.3, 0.9}}}},
                                         {"right", {{{-2.9, 0.3, 0.1}, {0, 0.9, 0.9}}}},
                                         {"latch", {{{-length, -0.1, 0.1}, {length, 0.1, 0.9}}}}});
  Mesh latch = *assembly.parts[3].mesh;
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle + 0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()));
  for (auto& v : latch.vertices) v = q * v;
  const auto base = static_cast<std::uint32_t>(latch.vertices.size());
  constexpr std::uint32_t kCorners = 24;
  for (const double z : {0.8, 1.9})
    for (std::uint32_t k = 0; k < kCorners; ++k) {
      const double a = 2 * std::numbers::pi * k / kCorners;
      latch.vertices.emplace_back(0.25 * std::cos(a), 0.25 * std::sin(a), z);
    }
  for (std::uint32_t k = 0; k < kCorners; ++k) {
    const std::uint32_t a = base + k, b = base + (k + 1) % kCorners;
    latch.triangles.push_back({a, b, a + kCorners});
    latch.triangles.push_back({b, b + kCorners, a + kCorners});
    if (a == base || b == base) continue;
    latch.triangles.push_back({base, b, a});
    latch.triangles.push_back({base + kCorners, a + kCorners, b + kCorners});
  }
  for (auto& v : latch.vertices) v.x() += 1.2;
  assembly.parts[3].mesh = assembly.parts[3].surface = std::make_shared<const Mesh>(latch);
  return assembly;
}

TEST(Blocking, TurnsWhatIsInTheWayAndLeavesItTurned) {
  Rng rng(5);
  for (int trial = 0; trial < 8; ++trial) {
    const Assembly assembly = latched_rails(rng.uniform(-0.4, 0.4), rng.uniform(0.6, 0.9));
    for (const bool turns : {true, false}) {
      BlockingParameters params;
      params.rotations = turns;
      params.translation_states = 0;
      RunContext context;
      const RunResult r =
          run(assembly, fake::setup(helpless, std::make_shared<Blocking>(params)), RunOptions{}, context);
      ASSERT_EQ(r.plan.disassembly.size(), turns ? 3u : 0u);
      if (!turns) continue;
      EXPECT_TRUE(r.plan.disassembly[0].separates.empty()) << "turned, and still there";
      EXPECT_EQ(r.plan.disassembly[0].moves[0].part, "latch");
      EXPECT_EQ(r.plan.unsolved.size(), 2u) << "the latch never leaves the channel";
      EXPECT_TRUE(check_plan(r.plan, assembly, RunOptions{}.verify, context).valid);
    }
  }
}

TEST(Blocking, KeepsTheConstraints) {
  RunOptions options;
  options.constraints.base = {0};
  options.constraints.target = 4;  // of six blocks: exactly those above it have to be removed
  const RunResult target = take_apart(fake::tube_with_blocks(6), 1, options);
  std::string steps;
  for (const auto& step : target.plan.disassembly)
    for (const auto& name : step.separates[0]) steps += name + " ";
  ASSERT_EQ(steps, "block6 block5 block4 ");
  EXPECT_EQ(target.plan.disassembly.back().separates[0][0], "block4");
  EXPECT_EQ(target.outcome, Outcome::solved);

  options.constraints = {};
  options.constraints.before = {{5, 0}, {0, 3}};
  const RunResult ordered = take_apart(fake::row(6), 1, options);
  std::vector<std::string> order;
  for (const auto& step : ordered.plan.disassembly) order.push_back(step.separates[0][0]);
  const auto at = [&](const char* name) { return std::find(order.begin(), order.end(), name) - order.begin(); };
  EXPECT_LT(at("block5"), at("block0"));
  EXPECT_LT(at("block0"), at("block3"));

  options.constraints = {};
  options.constraints.together = {{1, 2}, {2, 3}};
  options.constraints.base = {0};
  const RunResult kept = take_apart(fake::row(6), 1, options);
  EXPECT_EQ(kept.outcome, Outcome::solved);
  for (const auto& step : kept.plan.disassembly)
    for (const auto& group : step.separates) {
      const std::set<std::string> names(group.begin(), group.end());
      EXPECT_FALSE(names.contains("block0"));
      EXPECT_EQ(names.contains("block1"), names.contains("block2"));
      EXPECT_EQ(names.contains("block1"), names.contains("block3"));
    }
}

}  // namespace
}  // namespace dismantle
