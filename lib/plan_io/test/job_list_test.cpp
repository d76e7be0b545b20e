// The fasteners and tools of a whole job: each part is counted once, each tool with what it is for.
#include "dismantle/plan_io/job_list.h"

#include <gtest/gtest.h>

namespace dismantle {
namespace {

PlanStep step_of(unsigned number, const std::string& part, std::vector<StepNote> notes = {}) {
  PlanStep step;
  step.step = number;
  step.moves.push_back({part, {}});
  step.checks.push_back({.type = "tool_access", .notes = std::move(notes)});
  return step;
}

StepNote tool(const std::string& part, const std::string& more = "") {
  return {"tool_access.tool", "",
          R"({"part": ")" + part + R"(", "tool": "hex_key_2.5", "name": "hex key 2.5", "drive": "hex socket 2.5")" +
              more + "}"};
}

/// A lid with two screws and a bolt with its nut; a nut that comes last is held by a key.
Plan plan_of_lid() {
  Plan plan;
  const auto add = [&](const std::string& name, PartKind kind) {
    PlanPart part;
    part.id = static_cast<unsigned>(plan.assembly.parts.size());
    part.name = name;
    part.kind = std::move(kind);
    plan.assembly.parts.push_back(std::move(part));
  };
  add("base", {"housing", "", 0.9});
  add("lid", {"plate", "", 0.9});
  add("s1", {"screw", "M3x10", 0.9});
  add("s2", {"screw", "M3x10", 0.9});
  add("bolt", {"screw", "M12x40", 1, "stated by the user; torque 0.6 N m; glue: blue, a drop", true});
  add("nut", {"nut", "M12", 0.9});
  add("inlay", {"nut", "M12", 0.8, "shape: ring inside nut 'nut'"});
  plan.disassembly = {
      step_of(
          1, "nut",
          {tool("nut",
                R"(, "hold": {"part": "bolt", "tool": "key_10", "name": "hex key 10", "drive": "hex socket 10"})")}),
      step_of(2, "s1", {tool("s1")}), step_of(3, "bolt"), step_of(4, "s2", {tool("s2")}), step_of(5, "lid")};
  return plan;
}

TEST(JobList, EqualFastenersAreOneRowWithTheirTools) {
  const JobList job = job_list(plan_of_lid());
  ASSERT_EQ(job.fasteners.size(), 3u);
  EXPECT_EQ(fastener_words(job.fasteners[0]), "2x screw M3x10: hex key 2.5");
  EXPECT_EQ(job.fasteners[0].steps, (std::vector<std::size_t>{2, 4}));
  EXPECT_EQ(job.fasteners[0].drive, "hex socket 2.5");
  EXPECT_EQ(fastener_words(job.fasteners[1]), "1x screw M12x40: hex key 10; 0.6 N m; glue: blue, a drop");
  EXPECT_EQ(job.fasteners[2].parts, std::vector<std::string>{"nut"});
  ASSERT_EQ(job.tools.size(), 2u);
  EXPECT_EQ(tool_words(job.tools[0]), "hex key 2.5: 2x M3x10, 1x M12, steps 2, 4, 5");
  EXPECT_EQ(tool_words(job.tools[1]), "hex key 10: 1x M12x40, step 5");
}

TEST(JobList, TablesQuoteWhatHasCommas) {
  const std::string fasteners = fasteners_csv(plan_of_lid()), tools = tools_csv(plan_of_lid());
  EXPECT_NE(fasteners.find("2,screw,M3x10,hex socket 2.5,hex key 2.5,,,2;4,s1;s2\n"), std::string::npos) << fasteners;
  EXPECT_NE(fasteners.find("1,screw,M12x40,hex socket 10,hex key 10,0.6,\"blue, a drop\",3,bolt\n"), std::string::npos);
  EXPECT_NE(tools.find("hex_key_2.5,hex key 2.5,2x M3x10;1x M12,2;4;5\n"), std::string::npos) << tools;
}

TEST(JobList, AProductInOnePieceIsNoFastener) {
  Plan plan = plan_of_lid();
  plan.assembly.components = {{"motor", "motor", {"base", "s1"}, true, ""},
                              {"lock nut", "lock nut", {"nut", "inlay"}, true, ""}};
  const JobList job = job_list(plan);
  ASSERT_EQ(job.fasteners.size(), 3u);
  EXPECT_EQ(job.fasteners[0].parts, std::vector<std::string>{"s2"});
  EXPECT_EQ(job.fasteners[2].parts, std::vector<std::string>{"nut"});
}

// Where no tool reaches a screw, its row is that of the others.
TEST(JobList, ABlockedScrewHasItsDrive) {
  Plan plan = plan_of_lid();
  plan.disassembly[1].checks[0].notes[0].kind = "tool_access.blocked";
  const JobList job = job_list(plan);
  EXPECT_EQ(fastener_words(job.fasteners[0]), "2x screw M3x10: hex key 2.5");
  EXPECT_EQ(tool_words(job.tools[0]), "hex key 2.5: 1x M3x10, 1x M12, steps 2, 5");
}

// A plan without verdicts has fasteners without tools; notes that are no JSON are passed over.
TEST(JobList, WithoutNotesThereAreNoTools) {
  Plan plan = plan_of_lid();
  plan.disassembly[0].checks.clear();
  plan.disassembly[1].checks[0].notes[0].data = "{";
  plan.disassembly[3].checks[0].notes[0].kind = "acme.tool";
  const JobList job = job_list(plan);
  EXPECT_TRUE(job.tools.empty());
  EXPECT_EQ(fastener_words(job.fasteners[0]), "2x screw M3x10");
}

}  // namespace
}  // namespace dismantle
