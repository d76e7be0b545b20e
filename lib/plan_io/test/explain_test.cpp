// Explanations match the plan: every part once, lengths in input units, advice that names a key.
#include "dismantle/plan_io/explain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "dismantle/errors.h"
#include "dismantle/run_context.h"

namespace dismantle {
namespace {

constexpr Outcome kFailures[] = {Outcome::timeout,     Outcome::depth_limit,   Outcome::exhausted,
                                 Outcome::infeasible,  Outcome::invalid_start, Outcome::cancelled,
                                 Outcome::unsupported, Outcome::crashed};

std::string name(std::size_t i) { return "part " + std::to_string(i); }

/// A plan of `count` parts, the first of which came out, the others not.
Plan partial_plan(std::size_t count, Rng& rng) {
  Plan plan;
  PlanAssembly& a = plan.assembly;
  a.source = "gearbox/";
  a.scale = 0.1;  // assembly units per input unit
  a.unit = "mm";
  a.box.extend({0, 0, 0});
  a.box.extend({100, 50, 25});
  a.center = {50, 25, 12.5};
  for (unsigned i = 0; i < count; ++i) a.parts.push_back({i, name(i), "f.obj"});
  for (std::size_t i = 1; i < count; ++i) {
    plan.remaining.push_back(name(i));
    const Outcome outcome = kFailures[rng.below(std::size(kFailures))];
    PlanUnsolved u{name(i),
                   outcome,
                   {name(1 + rng.below(count - 1))},
                   {{rng.uniform(1, 9), 0, 0}, Eigen::Quaterniond::Identity()},
                   "same words"};
    u.planner = "guided";
    u.attempts = 3;
    u.depth = 4;
    u.seconds = 1.5;
    u.places.push_back({u.blocked_by[0], {rng.uniform(), rng.uniform(), rng.uniform()}});
    plan.unsolved.push_back(u);
  }
  PlanStep step;
  step.step = 1;
  step.layer = 1;
  step.moves = {{name(0), {{}, {}}}};
  step.separates = {{name(0)}};
  plan.disassembly = {step};
  return plan;
}

TEST(Explain, EveryPartThatIsLeftStandsInOneReason) {
  Rng rng(3);
  for (int round = 0; round < 50; ++round) {
    const Plan plan = partial_plan(2 + rng.below(30), rng);
    const Explanation e = explain(plan, {});
    std::multiset<std::string> explained;
    std::set<Outcome> outcomes;
    for (const LeftReason& reason : e.left) {
      EXPECT_TRUE(outcomes.insert(reason.outcome).second) << "one reason, one place";
      EXPECT_FALSE(reason.advice.empty()) << to_string(reason.outcome);
      for (const LeftPart& part : reason.parts) explained.insert(part.part);
    }
    EXPECT_EQ(explained, std::multiset<std::string>(plan.remaining.begin(), plan.remaining.end()));
    EXPECT_TRUE(std::ranges::is_sorted(e.left, std::greater{}, [](const LeftReason& r) { return r.parts.size(); }));
    EXPECT_TRUE(e.untried.empty());
    // One text is said once, however many parts it is about.
    const std::string text = explain_text(e);
    std::size_t said = 0;
    for (std::size_t at = 0; (at = text.find("same words", at)) != std::string::npos; ++at) ++said;
    EXPECT_EQ(said, e.left.size());
    EXPECT_EQ(text.find("assembly units"), std::string::npos);
  }
}

TEST(Explain, LengthsAreInInputUnits) {
  Rng rng(1);
  Plan plan = partial_plan(3, rng);
  plan.assembly.overlaps = {{name(1), name(2), 0.25}};  // assembly units
  plan.unsolved[0].blocked_by = {name(2)};
  plan.unsolved[0].places = {{name(2), {1, 2, 3}}};
  plan.unsolved[0].best_pose = {{0, 0, 7}, Eigen::Quaterniond::Identity()};
  const Explanation e = explain(plan, {}, name(1));
  ASSERT_EQ(e.left.size(), 1u);
  const LeftPart& part = e.left[0].parts.at(0);
  EXPECT_DOUBLE_EQ(part.travel, 7);
  ASSERT_EQ(part.blockers.size(), 1u);
  EXPECT_DOUBLE_EQ(part.blockers[0].overlap, 2.5);
  ASSERT_TRUE(part.blockers[0].at);
  const std::string text = explain_text(e);
  EXPECT_NE(text.find("came 7 mm (7.0 % of the assembly's largest edge)"), std::string::npos) << text;
  EXPECT_NE(text.find("blocked by: part 2 at (1, 2, 3) (overlaps it by 2.5 mm when assembled)"), std::string::npos)
      << text;
  EXPECT_NE(text.find("tried: 3 searches by guided to depth 4, 1.5 s"), std::string::npos) << text;
  EXPECT_NE(text.find("dismantle check gearbox/"), std::string::npos) << text;
}

TEST(Explain, AdviceNamesTheKeyAndWhatItWas) {
  Rng rng(2);
  const auto advice = [&](Outcome outcome, const ExplainSettings& settings, const std::string& message = "") {
    Plan plan = partial_plan(2, rng);
    plan.unsolved[0].outcome = outcome;
    plan.unsolved[0].message = message;
    std::string all;
    const Explanation e = explain(plan, settings);
    for (const std::string& line : e.left.at(0).advice) all += line + "\n";
    return all;
  };
  const ExplainSettings settings{{"run.path_timeout", "60"},          {"run.timeout", "600"},
                                 {"sequence_planner.max_depth", "6"}, {"run.path_steps", "0"},
                                 {"path_planner.type", "guided"},     {"sequence_planner.type", "blocking"}};
  EXPECT_NE(advice(Outcome::timeout, settings).find("`--path-timeout 120`, key run.path_timeout (was 60 s)"),
            std::string::npos);
  EXPECT_EQ(advice(Outcome::timeout, settings).find("path_steps"), std::string::npos) << "there was no such limit";
  EXPECT_NE(advice(Outcome::timeout, settings, "the time limit of the whole run passed").find("`--timeout 1200`"),
            std::string::npos);
  EXPECT_NE(advice(Outcome::depth_limit, settings)
                .find("`--set sequence_planner.max_depth=12`, key "
                      "sequence_planner.max_depth (was 6)"),
            std::string::npos);
  EXPECT_EQ(advice(Outcome::depth_limit, settings).find("--path-planner"), std::string::npos) << "guided was used";
  EXPECT_NE(advice(Outcome::depth_limit, {{"path_planner.type", "bfs"}}).find("--path-planner guided"),
            std::string::npos);
  EXPECT_NE(advice(Outcome::infeasible, settings).find("verify.max_penetration"), std::string::npos);
  EXPECT_NE(advice(Outcome::exhausted, settings, "the constraints hold it back").find("`constraints`"),
            std::string::npos);
}

TEST(Explain, AShellReadsTheNamesInCommandsAsTheyAre) {
  Rng rng(4);
  for (const std::string source : {"plain", "with space", "it's", "$(rm -rf x)", "a\"b", "é;|&", "-x", "a/b.step"}) {
    Plan plan = partial_plan(2, rng);
    plan.assembly.source = source;
    plan.unsolved[0].outcome = Outcome::invalid_start;
    const std::string advice = explain(plan, {}).left.at(0).advice.at(0), command = "`dismantle check ";
    ASSERT_TRUE(advice.starts_with(command)) << advice;
    const std::string word = advice.substr(command.size(), advice.rfind('`') - command.size());
    FILE* shell = popen(("printf %s " + word).c_str(), "r");
    ASSERT_NE(shell, nullptr);
    std::string read(64, '\0');
    read.resize(std::fread(read.data(), 1, read.size(), shell));
    EXPECT_EQ(pclose(shell), 0);
    EXPECT_EQ(read, source);
  }
}

TEST(Explain, HowFarAPartCameCountsFromItsLastPoseInThePlan) {
  Rng rng(6);
  Plan plan = partial_plan(3, rng);
  const Pose away{{0, 40, 0}, rotation_from_vector({0, 0, 1})};
  plan.disassembly[0].moves = {{name(1), {Pose{}, away}}, {name(2), {Pose{}, away}}};
  plan.disassembly[0].separates = {{name(1), name(2)}};
  plan.unsolved[0].best_pose = away;
  plan.unsolved[1].best_pose = Pose{{3, 0, 0}, Eigen::Quaterniond::Identity()} * away;
  const auto left = [&](std::size_t i) { return explain(plan, {}, name(i)).left.at(0).parts.at(0); };
  EXPECT_FALSE(left(1).moved);
  EXPECT_EQ(left(1).travel, 0);
  EXPECT_TRUE(left(2).moved);
  EXPECT_NEAR(left(2).travel, 3, 1e-12);
  EXPECT_NE(explain_text(explain(plan, {}, name(1))).find("it did not move"), std::string::npos);
}

// Law: whatever the depth, the line accepts a step of that depth, and not one that is deeper by a fifth.
TEST(Explain, TheLineThatAcceptsAForcedStep) {
  Rng rng(7);
  for (int round = 0; round < 200; ++round) {
    PlanForced forced{.part = "it's", .other = "rim", .depth = std::pow(10, rng.uniform(-4, 3)), .reason = "it snaps"};
    const std::string line = acceptance_line(forced), begin = "constraints: {accept: [{part: 'it''s', against: 'rim', as: snap, depth: ";
    ASSERT_TRUE(line.starts_with(begin)) << line;
    const double depth = std::stod(line.substr(begin.size()));
    EXPECT_GE(depth, forced.depth) << line;
    EXPECT_LT(depth, 1.2 * forced.depth) << line;
    EXPECT_NE(forced_advice(forced).find(line), std::string::npos);
    forced.reason = "it snaps, as " + line;
    EXPECT_EQ(forced_advice(forced), "") << "its reason says so";
    forced.accepted = "snap";
    EXPECT_EQ(acceptance_line(forced), "");
  }
}

// Law: how far a forced step comes is said in the unit of people, along its path; where nothing is known, nothing is said.
TEST(Explain, HowFarAForcedStepComes) {
  Rng rng(11);
  const auto at = [](double z) { return Pose{{0, 0, z}, Eigen::Quaterniond::Identity()}; };
  for (int round = 0; round < 50; ++round) {
    Plan plan = partial_plan(3, rng);
    PlanStep& step = plan.disassembly[0];
    step.moves = {{name(0), {at(0), at(0.5), at(20), at(90)}}};
    step.forced = PlanForced{.part = name(0), .other = name(1), .depth = 1, .reason = "it snaps"};
    EXPECT_EQ(reached_text(plan, length_unit(plan), step), "");
    EXPECT_EQ(explain_text(explain(plan, {})).find("how far"), std::string::npos);
    const int far = 1 + static_cast<int>(rng.below(89));
    step.moves[0].poses[2] = at(far);
    step.transfer = 2;
    const std::string text = reached_text(plan, length_unit(plan), step);
    EXPECT_NE(text.find(" mm up (+Z)"), std::string::npos) << text;
    EXPECT_TRUE(text.starts_with("part 0 comes ") && text.ends_with(" without cutting in")) << text;
    EXPECT_NE(explain_text(explain(plan, {})).find("how far: " + text), std::string::npos);
    const auto json = nlohmann::json::parse(explain_json(explain(plan, {})))["steps"][0]["forced"];
    EXPECT_EQ(json["how_far"], text);
    EXPECT_EQ(json["reached"][0]["pose"][2], far);
    EXPECT_EQ(json["reached"][0]["part"], name(0));
    step.moves[0].poses = {at(0), at(0.01), at(90)};
    step.transfer = 1;
    EXPECT_EQ(reached_text(plan, length_unit(plan), step), "part 0 cuts in from the beginning");
  }
}

TEST(Explain, OrderIsThatOfThePlan) {
  Rng rng(5);
  for (int round = 0; round < 30; ++round) {
    Plan plan;
    plan.status = PlanStatus::complete;
    const unsigned count = 2 + static_cast<unsigned>(rng.below(9));
    for (unsigned i = 0; i < count; ++i) plan.assembly.parts.push_back({i, name(i), "f.obj"});
    for (unsigned i = 1; i < count; ++i) {
      PlanStep step;
      step.step = i;
      step.layer = 1;
      step.moves = {{name(i), {{}, {}}}};
      step.separates = {{name(i)}};
      for (unsigned a = 1; a < i; ++a)
        if (rng.below(3) == 0) step.after.push_back(a);
      PlanVerdict check;
      check.notes = {{"gravity", "Hold '" + name(i) + "': it falls down otherwise.", ""}};
      step.checks.push_back(check);
      plan.disassembly.push_back(step);
    }
    const Explanation e = explain(plan, {});
    ASSERT_EQ(e.steps.size(), count - 1);
    for (const StepReason& step : e.steps)
      EXPECT_NE(explain_text(e).find("put in: Hold '" + step.parts.front() + "'"), std::string::npos);
    for (const StepReason& step : e.steps) {
      ASSERT_EQ(step.after.size(), step.waited_for.size());
      for (std::size_t k = 0; k < step.after.size(); ++k) EXPECT_EQ(step.waited_for[k], name(step.after[k]));
    }
    const auto json = nlohmann::json::parse(explain_json(e));
    EXPECT_EQ(json["steps"].size(), count - 1);
    EXPECT_EQ(json["steps"][0]["notes"].size(), 1u);
    EXPECT_EQ(json["status"], "complete");
    EXPECT_EQ(explain(plan, {}, name(1)).steps.size(), 1u);
    EXPECT_TRUE(explain(plan, {}, name(0)).steps.empty());
    EXPECT_NE(explain_text(explain(plan, {}, name(0))).find("stays where it is"), std::string::npos);
  }
  EXPECT_THROW(explain(Plan{}, {}, "nut"), InputError);
}

}  // namespace
}  // namespace dismantle
