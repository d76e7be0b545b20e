// What the page shows of each step, for random plans.
#include "page_steps.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "dismantle/plan_io/input_frame.h"
#include "random_disassembly.h"
#include "random_plan.h"

namespace dismantle {
namespace {

using StepsJson = nlohmann::ordered_json;

Eigen::Quaterniond quaternion_of(const StepsJson& q) {
  return {q[0].get<double>(), q[1].get<double>(), q[2].get<double>(), q[3].get<double>()};
}

/// Random plans of rows of boxes.
template <class Law>
void for_plans(Law law) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Rng rng(seed);
    std::vector<std::pair<std::string, Mesh>> meshes;
    for (std::size_t i = 0; i < 2 + rng.below(5); ++i) {
      Mesh m;
      for (int c = 0; c < 8; ++c)
        m.vertices.emplace_back(2.0 * static_cast<double>(i) + (c & 1), c & 2 ? 1 : 0, c & 4 ? 1 : 0);
      m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}};
      meshes.emplace_back("p" + std::to_string(i), std::move(m));
    }
    const Assembly assembly = assembly_of_meshes(meshes, 1, Eigen::Vector3d::Zero());
    law(random_plan(assembly, rng).plan, assembly);
  }
}

TEST(PageSteps, WhatIsUpInAStepPointsUpwards) {
  std::size_t lying = 0;
  for_plans([&](Plan plan, const Assembly&) {
    for (const bool y_up : {false, true}) {
      for (PlanPart& part : plan.assembly.parts) part.file = y_up ? "x.glb" : "x.obj";
      plan.objective.up = y_up ? Eigen::Vector3d(0, -1, 0) : Eigen::Vector3d(0, 0, 1);
      const StepsJson steps = page_steps(plan);
      const std::size_t n = plan.disassembly.size();
      ASSERT_EQ(steps["disassembly"].size(), n);
      ASSERT_EQ(steps["assembly"].size(), plan.assembly_steps.size());
      const bool said = std::ranges::any_of(plan.disassembly, [](const PlanStep& s) { return s.up.has_value(); });
      const Eigen::Vector3d up = input_frame(plan).up;
      for (std::size_t s = 0; s < n; ++s) {
        const StepsJson& step = steps["disassembly"][s];
        ASSERT_EQ(step.contains("lies"), said);
        if (!said) continue;
        ++lying;
        const Eigen::Vector3d lies = plan.disassembly[s].up.value_or(up);
        EXPECT_LT((quaternion_of(step["lies"]) * lies - up).norm(), 1e-9);
        EXPECT_EQ(step["lies_words"].get<std::string>().starts_with("as drawn"), lies == up);
        EXPECT_EQ(step["turned"], s > 0 && plan.disassembly[s].up != plan.disassembly[s - 1].up);
        if (plan.assembly_steps.size() == n) {
          EXPECT_EQ(steps["assembly"][n - 1 - s]["lies"], step["lies"]) << "backwards it lies alike";
        }
      }
    }
  });
  EXPECT_GT(lying, 20u);
}

TEST(PageSteps, EveryPartThatANoteHoldsIsNamedInBothDirections) {
  std::size_t held = 0;
  for_plans([&](Plan plan, const Assembly& assembly) {
    Rng rng(plan.disassembly.size() + 7 * assembly.parts.size());
    const std::size_t n = plan.disassembly.size();
    std::vector<std::set<std::size_t>> truth(n);
    for (std::size_t s = 0; s < n; ++s) {
      PlanVerdict verdict{.type = "gravity"};
      for (std::uint64_t notes = rng.below(3); notes > 0; --notes) {
        const std::size_t part = rng.below(assembly.parts.size());
        truth[s].insert(part);
        const StepsJson hold = {{{"part", assembly.parts[part].name}, {"when", "during"}, {"newton", 2.5}}};
        verdict.notes.push_back({"gravity", "Hold it.", StepsJson{{"hold", hold}, {"hands", 2}}.dump()});
      }
      // What other checks write is no hold.
      for (const char* data : {"", "{}", R"({"hold": "p0"})", R"({"hold": ["p0", {"part": 3}, {"part": "ghost"}]})"})
        verdict.notes.push_back({"acme", "A note.", data});
      held += truth[s].size();
      plan.disassembly[s].checks = {verdict};
    }
    const StepsJson steps = page_steps(plan);
    for (std::size_t s = 0; s < n; ++s) {
      const auto told = steps["disassembly"][s].value("hold", std::set<std::size_t>{});
      EXPECT_EQ(told, truth[s]);
      if (plan.assembly_steps.size() != n) continue;
      EXPECT_EQ(steps["assembly"][n - 1 - s].value("hold", std::set<std::size_t>{}), truth[s]);
    }
  });
  EXPECT_GT(held, 50u);
}

}  // namespace
}  // namespace dismantle
