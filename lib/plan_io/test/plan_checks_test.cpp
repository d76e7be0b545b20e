// Objective and verdicts of step checks in plan.json and in the texts that are made of it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "dismantle/errors.h"
#include "dismantle/plan_io/exports.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/verdicts.h"
#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

// JSON that a parser and a writer would change: numbers, escapes, order, spaces, line breaks; and braces in texts.
const char* const kData[] = {"{}",
                             "{ }",
                             R"({"b":1.0e3,"a":1.50})",
                             R"({ "x" : "\u00e9}{" , "notes":[{"data":{}}] })",
                             "{\n\t\"deep\": [ {\"data\": {\"q\": -0.0}}, [] ]\r\n}",
                             R"({"é":"</script>"})"};

Plan judged_plan() {
  Plan plan;
  plan.generator_version = "0.1.0";
  plan.assembly.source = "box";
  plan.assembly.parts = {{0, "peg", "peg.obj"}, {1, "hole", "hole.obj"}, {2, "lid", "lid.obj"}};
  plan.remaining = {"hole"};
  const auto step = [&](const std::string& part) {
    PlanStep s;
    s.step = static_cast<unsigned>(plan.disassembly.size()) + 1;
    s.moves = {{part, {Pose{}, Pose{{0, 0, 1}, Eigen::Quaterniond::Identity()}}}};
    s.separates = {{part}};
    s.planner = "bfs";
    plan.disassembly.push_back(s);
    plan.assembly_steps.insert(plan.assembly_steps.begin(), s);
  };
  step("lid");
  step("peg");
  for (std::size_t k = 0; k < 2; ++k) {
    plan.assembly_steps[k].step = static_cast<unsigned>(k) + 1;
    PlanVerdict& v = plan.disassembly[k].checks.emplace_back();
    v.type = "acme.hold";
    v.weight = 2;
    v.cost = 0.5;
    v.allowed = k == 0;
    v.reason = k == 0 ? "it is heavy" : "it falls over";
    v.notes.push_back({"hold", "Hold the part.", R"({"part":"peg", "force":1.50})"});
  }
  plan.objective.checks.push_back({"acme.hold", 2, true, {{"hands", std::int64_t{1}}}, 1, {}});
  plan.objective.cost = 2;
  return plan;
}

TEST(PlanChecks, AreReadAsTheyWereWritten) {
  Rng rng(1);
  for (int trial = 0; trial < 200; ++trial) {
    Plan plan = judged_plan();
    plan.objective.up = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    plan.objective.checks[0].parameters["share"] = rng.uniform();
    PlanVerdict& v = plan.disassembly[rng.below(2)].checks[0];
    v.cost = rng.uniform();
    if (rng.below(2)) v.failed = "no reason";
    if (rng.below(2)) v.notes.clear();
    for (auto n = rng.below(3); n > 0; --n) v.notes.push_back({"k", "t\n\"", kData[rng.below(std::size(kData))]});
    if (rng.below(2)) v.certificate = PlanCertificate{"stands", {"peg", "hole"}, {}, true, 0.5, {{"x", {1, 2}}}, "why"};
    if (rng.below(2)) plan.objective.checks[0].plan = v;
    if (rng.below(2)) plan.objective.alternatives.push_back({0, 0, {v}});
    if (rng.below(2)) plan.objective.alternatives.push_back({1, 2, {v}});
    const std::string text = to_json(plan);
    const Plan read = plan_from_json(text, "plan.json");
    EXPECT_EQ(to_json(read), text);
    ASSERT_EQ(read.objective.checks.size(), 1u);
    EXPECT_EQ(read.objective.up, plan.objective.up);
    EXPECT_EQ(read.objective.checks[0].parameters, plan.objective.checks[0].parameters);
    EXPECT_TRUE(read.objective.checks[0].require);
    ASSERT_EQ(read.objective.alternatives.size(), plan.objective.alternatives.size());
    for (std::size_t k = 0; k < read.objective.alternatives.size(); ++k) {
      const PlanAlternative &a = plan.objective.alternatives[k], &b = read.objective.alternatives[k];
      EXPECT_EQ(std::pair(a.step, a.place), std::pair(b.step, b.place));
      EXPECT_EQ(a.checks.at(0).cost, b.checks.at(0).cost);
    }
    for (std::size_t k = 0; k < 2; ++k) {
      const PlanVerdict &a = plan.disassembly[k].checks[0], &b = read.disassembly[k].checks[0];
      EXPECT_EQ(a.type, b.type);
      EXPECT_EQ(a.weight, b.weight);
      EXPECT_EQ(a.cost, b.cost);
      EXPECT_EQ(a.allowed, b.allowed);
      EXPECT_EQ(a.reason, b.reason);
      EXPECT_EQ(a.failed, b.failed);
      EXPECT_EQ(a.notes, b.notes);
      ASSERT_EQ(a.certificate.has_value(), b.certificate.has_value());
      if (a.certificate) {
        EXPECT_EQ(a.certificate->numbers, b.certificate->numbers);
      }
    }
  }
}

// Law: the data of a note is the same text after writing, reading and writing, also if another program wrote the file.
TEST(PlanChecks, DataOfNotesIsKeptByteForByte) {
  for (const std::string data : kData) {
    Plan plan = judged_plan();
    plan.disassembly[0].checks[0].notes = {{"a", "b", data}, {"c", "d", ""}, {"e", "f", "{}"}};
    const std::string text = to_json(plan);
    EXPECT_NE(text.find("\"data\": " + data), std::string::npos) << "as an object, not as a string";
    EXPECT_EQ(plan_from_json(text, "p").disassembly[0].checks[0].notes[0].data, data);
    std::string other = text;
    const std::string from = "\"data\": " + data;
    other.replace(other.find(from), from.size(), "\n\"data\"\t:\n" + data);
    const Plan read = plan_from_json(other, "p");
    EXPECT_EQ(read.disassembly[0].checks[0].notes, plan.disassembly[0].checks[0].notes);
    EXPECT_TRUE(nlohmann::json::accept(text));
  }
}

TEST(PlanChecks, WhatIsNoObjectIsNoData) {
  for (const char* const data : kData) EXPECT_TRUE(is_json_object(data)) << data;
  for (const char* const data :
       {"", "[]", "1", "\"x\"", "{", "{} {}", "{\"a\":1,\"a\":2}", "{\"a\":nan}", "{\"\xff\":1}"})
    EXPECT_FALSE(is_json_object(data)) << data;
}

TEST(PlanChecks, WrongOnesAreNamedWithTheirPlace) {
  std::string text = to_json(judged_plan());
  const auto expect = [&](const std::string& from, const std::string& to, const std::string& message) {
    std::string changed = text;
    ASSERT_NE(changed.find(from), std::string::npos) << from;
    changed.replace(changed.find(from), from.size(), to);
    try {
      plan_from_json(changed, "p");
      ADD_FAILURE() << "accepted: " << to;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
    }
  };
  const std::string data = R"({"part":"peg", "force":1.50})";
  expect(data, "[" + data + "]", "/disassembly/0/checks/0/notes/0/data: expected an object");
  expect(data, "3", "/disassembly/0/checks/0/notes/0/data: expected an object");
  expect("\"allowed\": true", "\"allowed\": 1", "/disassembly/0/checks/0/allowed: expected true or false");
  expect("\"cost\": 0.5", "\"cost\": -1", "/disassembly/0/checks/0/cost: expected a number >= 0");
  expect("\"up\": [0, 0, 1]", "\"up\": [0, 0, 2]", "/objective/up: expected a vector of length 1");
  expect("\"kind\": \"hold\"", "\"kind\": \"\"", "/disassembly/0/checks/0/notes/0/kind");
  Plan plan = judged_plan();
  plan.objective.alternatives = {{.step = 2, .place = 1, .checks = {{.type = "acme.hold", .weight = 2, .cost = 7}}}};
  text = to_json(plan);
  for (const char* place : {"2", "0", "3"})
    expect("\"place\": 1", "\"place\": " + std::string(place),
           "/objective/alternatives/0: expected the numbers of two");
  expect("\"cost\": 7", "\"cost\": -7", "/objective/alternatives/0/checks/0/cost: expected a number >= 0");
}

TEST(PlanChecks, WithoutAnObjectiveThereIsNothing) {
  Plan plan = judged_plan();
  plan.objective = {};
  for (PlanStep& step : plan.disassembly) step.checks.clear();
  const std::string text = to_json(plan);
  EXPECT_EQ(text.find("objective"), std::string::npos);
  EXPECT_EQ(text.find("checks"), std::string::npos);
  EXPECT_EQ(objective_text(plan), "");
  EXPECT_EQ(steps_markdown(plan, {}).find("operation"), std::string::npos);
}

TEST(PlanChecks, ReachTheTextsForPeopleAndPrograms) {
  const Plan plan = judged_plan();
  const std::string data = R"("data": {"part":"peg", "force":1.50})";
  Assembly assembly = shapes::assembly_of(
      {shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({1, 0, 0}, {2, 1, 1}), shapes::box({2, 0, 0}, {3, 1, 1})});
  for (std::size_t k = 0; k < 3; ++k) assembly.parts[k].name = plan.assembly.parts[k].name;
  const std::string poses = poses_json(plan, assembly, {});
  EXPECT_NE(poses.find(data), std::string::npos);
  const auto json = nlohmann::json::parse(poses);
  EXPECT_EQ(json["disassembly"][0]["checks"][0]["reason"], "it is heavy");
  EXPECT_EQ(json["assembly"][0]["checks"][0]["reason"], "it falls over") << "the last step of the disassembly";
  const std::string graph = and_or_json(plan);
  EXPECT_NE(graph.find(data), std::string::npos);
  const std::string markdown = steps_markdown(plan, {});
  for (const char* text :
       {"acme.hold: not allowed: it falls over", "acme.hold: cost 0.5: it is heavy", "Hold the part. (hold)", "1.50",
        "objective: 2 in all; acme.hold: 1, weight 2; 1 step not allowed"})
    EXPECT_NE(markdown.find(text), std::string::npos) << text << "\n" << markdown;
  EXPECT_NE(summary_text(plan).find("objective: 2 in all"), std::string::npos) << summary_text(plan);
}

}  // namespace
}  // namespace dismantle
