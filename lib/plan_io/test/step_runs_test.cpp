// Runs of equal steps, for random plans of boxes in known shapes and directions.
#include "dismantle/plan_io/step_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "dismantle/plan_io/exports.h"
#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"
#include "page_steps.h"

namespace dismantle {
namespace {

/// A plan that takes boxes out one by one, and what decides over its runs.
struct Row {
  Plan plan;
  Assembly assembly;
  std::vector<std::array<std::size_t, 4>> truth;  // by step: shape, direction, how it lies, forced
};

Row random_row(Rng& rng) {
  Row out;
  const std::size_t n = 2 + rng.below(12);
  out.assembly.input_box = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(4.0 * double(n), 4, 4)};
  out.plan.assembly.box = out.assembly.input_box;
  for (std::size_t i = 0; i <= n; ++i) {
    const std::size_t shape = rng.below(2);
    const std::string product = shape == 0 ? "cube" : "bar", name = product + "#" + std::to_string(i + 2);
    Part part;
    part.id = static_cast<PartId>(i);
    part.name = name;
    part.mesh = part.surface =
        std::make_shared<Mesh>(shapes::box({4.0 * double(i), 0, 0}, {4.0 * double(i) + 1, 1, shape == 0 ? 1.0 : 3.0}));
    out.assembly.parts.push_back(part);
    out.plan.assembly.parts.push_back({part.id, name, "x.step"});
    out.plan.assembly.parts.back().product = product;
    if (i == n) break;
    PlanStep step;
    step.step = static_cast<unsigned>(i + 1);
    step.layer = 1;
    if (i > 0) step.after = {static_cast<unsigned>(i)};
    step.separates = {{name}};
    step.contacts = {i > 0 ? out.plan.assembly.parts[i - 1].name : std::string("floor")};
    const std::size_t direction = rng.below(5) == 0, lies = rng.below(6) == 0, forced = rng.below(8) == 0;
    Pose away;
    away.t = rng.uniform(5, 9) * (direction == 0 ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(0, 1, 0));
    step.moves = {{name, {Pose{}, away}}};
    if (lies == 1) step.up = Eigen::Vector3d(0, 0, -1);
    if (forced == 1) step.forced = PlanForced{name, "floor", 0.1, 0, Eigen::Vector3d::Zero(), "held"};
    out.plan.disassembly.push_back(step);
    out.truth.push_back({shape, direction, lies, forced});
  }
  for (std::size_t k = 0; k < n; ++k) {
    PlanStep step = out.plan.disassembly[n - 1 - k];
    step.step = static_cast<unsigned>(k + 1);
    out.plan.assembly_steps.push_back(step);
  }
  return out;
}

template <class Law>
void for_rows(Law law) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Rng rng(seed);
    law(random_row(rng));
  }
}

TEST(StepRuns, StepsAreOfOneRunWhenShapeDirectionAndLieAreEqual) {
  std::size_t together = 0;
  for_rows([&](const Row& row) {
    for (const PartShapes& shapes : {shapes_of(row.plan), shapes_of(row.plan, row.assembly)}) {
      std::size_t next = 0;
      const std::vector<StepRun> runs = step_runs(row.plan, shapes);
      for (const StepRun& run : runs) {
        ASSERT_EQ(run.first, next) << "each step once, in order";
        next += run.count;
        for (std::size_t s = run.first + 1; s < next; ++s) {
          EXPECT_EQ(row.truth[s], row.truth[run.first]);
          EXPECT_EQ(row.truth[s][3], 0u) << "a forced step is told by itself";
          ++together;
        }
        if (next < row.truth.size() && row.truth[run.first][3] == 0) {
          EXPECT_NE(row.truth[next], row.truth[run.first]) << "the longest";
        }
        const std::string words = run_words(row.plan, run);
        EXPECT_EQ(words, std::to_string(run.count) + "x " + (row.truth[run.first][0] == 0 ? "cube" : "bar"));
      }
      EXPECT_EQ(next, row.plan.disassembly.size());
    }
  });
  EXPECT_GT(together, 200u);
}

TEST(StepRuns, BackwardsTheRunsAreTheSameSteps) {
  for_rows([](const Row& row) {
    const std::vector<StepRun> runs = step_runs(row.plan, shapes_of(row.plan));
    const nlohmann::ordered_json page = page_runs(row.plan, runs);
    const std::size_t n = row.plan.disassembly.size();
    std::vector<StepRun> apart, back;
    for (const auto& run : page["disassembly"]) apart.push_back({run["first"], run["count"]});
    for (const auto& run : page["assembly"]) back.push_back({run["first"], run["count"]});
    ASSERT_EQ(apart.size(), back.size());
    ASSERT_EQ(apart.size(),
              static_cast<std::size_t>(std::ranges::count_if(runs, [](const StepRun& r) { return r.count > 1; })));
    for (std::size_t r = 0; r < apart.size(); ++r) {
      const StepRun& mirrored = back[apart.size() - 1 - r];
      EXPECT_EQ(mirrored.count, apart[r].count);
      EXPECT_EQ(mirrored.first, n - apart[r].first - apart[r].count);
      EXPECT_EQ(page["disassembly"][r]["words"], page["assembly"][apart.size() - 1 - r]["words"]);
    }
  });
}

TEST(StepRuns, MarkdownHasARowPerRunWithAllNamesAndNumbers) {
  for_rows([](const Row& row) {
    const std::vector<StepRun> runs = step_runs(row.plan, shapes_of(row.plan));
    std::istringstream lines(steps_markdown(row.plan, input_frame(row.plan.assembly)));
    std::vector<std::string> rows;
    for (std::string line; std::getline(lines, line) && !line.starts_with("<details>");)
      if (line.starts_with("| ") && !line.starts_with("| step")) rows.push_back(line);
    ASSERT_EQ(rows.size(), runs.size());
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const unsigned first = static_cast<unsigned>(runs[r].first + 1),
                     last = first + static_cast<unsigned>(runs[r].count) - 1;
      const std::string numbers =
          first == last ? std::to_string(first) : std::to_string(first) + "–" + std::to_string(last);
      EXPECT_TRUE(rows[r].starts_with("| " + numbers + " |")) << rows[r];
      for (std::size_t s = runs[r].first; s < runs[r].first + runs[r].count; ++s) {
        std::string name = row.plan.disassembly[s].moves[0].part;
        name.insert(name.find('#'), "\\");
        EXPECT_NE(rows[r].find(name), std::string::npos) << rows[r];
      }
      // It waits for the step before the run alone.
      EXPECT_NE(rows[r].find(first == 1 ? "| - |" : "| " + std::to_string(first - 1) + " |"), std::string::npos)
          << rows[r];
    }
  });
}

TEST(StepRuns, PartsOfNoProductAreEqualToNoOther) {
  for_rows([](Row row) {
    for (PlanPart& part : row.plan.assembly.parts) part.product.clear();
    EXPECT_EQ(step_runs(row.plan, shapes_of(row.plan)).size(), row.plan.disassembly.size());
  });
}

}  // namespace
}  // namespace dismantle
