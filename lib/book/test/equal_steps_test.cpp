// Equal steps share a page: random rows of boxes on a plate, in known shapes and directions.
#include "equal_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <random>
#include <set>

#include "dismantle/plan_io/bill_items.h"
#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

/// A plate "base", and boxes that are lifted from it, or pulled sideways.
struct Row {
  Assembly assembly;
  Plan plan;
  std::vector<std::pair<bool, bool>> truth;  // by step: tall, sideways
};

Row row_on_plate(std::mt19937& random, std::size_t count) {
  Row out;
  out.assembly.normalization = {1, {0, 0, 0}};
  const auto add = [&](const std::string& name, const Eigen::Vector3d& lo, const Eigen::Vector3d& hi) {
    Part part;
    part.id = static_cast<PartId>(out.assembly.parts.size());
    part.name = name;
    part.mesh = part.surface = std::make_shared<Mesh>(shapes::box(lo, hi));
    for (const auto& v : part.mesh->vertices) out.assembly.input_box.extend(v);
    out.assembly.parts.push_back(part);
    out.plan.assembly.parts.push_back({part.id, name, "row.step"});
  };
  add("base", {-1, -1, -1}, {3.0 * double(count), 2, 0});
  for (std::size_t i = 0; i < count; ++i) {
    const bool tall = random() % 2 == 0, sideways = random() % 4 == 0;
    const double x = 3.0 * double(i);
    add((tall ? "post#" : "cube#") + std::to_string(i + 1), {x, 0, 0}, {x + 1, 1, tall ? 2.0 : 1.0});
    PlanStep step;
    step.step = static_cast<unsigned>(i + 1);
    Pose away;
    away.t = (sideways ? Eigen::Vector3d(0, 5, 0) : Eigen::Vector3d(0, 0, 5)) + Eigen::Vector3d(0, 0, 0.1 * (i % 3));
    if (sideways) away.t.z() = 0;
    const std::string& name = out.assembly.parts.back().name;
    step.moves = {{name, {Pose{}, away}}};
    step.separates = {{name}};
    out.plan.disassembly.push_back(step);
    out.truth.emplace_back(tall, sideways);
  }
  out.plan.assembly.source = "row.step";
  out.plan.assembly.box = out.assembly.input_box;
  out.plan.status = PlanStatus::complete;
  return out;
}

std::vector<std::size_t> items_of(const Row& row) {
  return bill_items(row.plan.assembly, row.assembly, geometry::find_congruent(row.assembly.parts));
}

TEST(EqualSteps, EachStepIsOnOnePageWithItsEquals) {
  std::mt19937 random(5);
  std::size_t joined = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Row row = row_on_plate(random, 2 + trial % 9);
    const std::vector<std::size_t> items = items_of(row);
    for (const bool disassembly : {false, true}) {
      std::vector<BookChapter> chapters = instructions(row.plan, row.assembly, disassembly);
      join_equal_steps(chapters, row.plan, row.assembly, items);
      ASSERT_EQ(chapters.size(), 1u);
      std::size_t next = 1;
      std::pair<bool, bool> before;
      for (const BookStep& step : chapters[0].steps) {
        EXPECT_EQ(step.number, next);
        next += 1 + step.joined.size();
        joined += step.joined.size();
        ASSERT_EQ(step.movers.size(), 1 + step.joined.size());
        std::vector<std::size_t> of_plan{step.plan_step};
        of_plan.insert(of_plan.end(), step.joined.begin(), step.joined.end());
        for (std::size_t k = 0; k < of_plan.size(); ++k) {
          EXPECT_EQ(row.truth[of_plan[k]], row.truth[step.plan_step]);
          EXPECT_EQ(step.movers[k].parts, std::vector<std::size_t>{of_plan[k] + 1});
          for (const PlacedPart& standing : step.standing) EXPECT_NE(standing.part, of_plan[k] + 1);
        }
        const std::size_t later = disassembly ? row.truth.size() + 1 - next : step.number - 1;
        EXPECT_EQ(step.standing.size(), 1 + later) << "the plate, and what is there before the first of them";
        if (step.number > 1) {
          EXPECT_NE(row.truth[step.plan_step], before) << "equal neighbours are joined";
        }
        before = row.truth[step.plan_step];
      }
      EXPECT_EQ(next, row.truth.size() + 1);
    }
  }
  EXPECT_GT(joined, 100u);
}

TEST(EqualSteps, AForcedStepAndPartsThatMoveTogetherStayAlone) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 30; ++trial) {
    Row row = row_on_plate(random, 6);
    const std::size_t forced = random() % 6;
    row.plan.disassembly[forced].forced = PlanForced{.part = "base", .other = "base", .depth = 0.1, .reason = "held"};
    std::vector<BookChapter> chapters = instructions(row.plan, row.assembly, false);
    join_equal_steps(chapters, row.plan, row.assembly, items_of(row));
    for (const BookStep& step : chapters[0].steps) {
      const bool has = step.plan_step == forced || std::ranges::find(step.joined, forced) != step.joined.end();
      EXPECT_TRUE(!has || step.joined.empty());
    }
  }
}

// A page shows one frame: that of the largest part that stays. Steps that are seen from parts that were displaced
// differently have no frame in common.
TEST(EqualSteps, StepsThatAreSeenFromDisplacedPartsStayAlone) {
  std::mt19937 random(9);
  for (const bool displaced : {false, true}) {
    Row row = row_on_plate(random, 4);
    row.plan.disassembly.clear();
    row.assembly.parts.erase(row.assembly.parts.begin());  // no plate: the first post that stays is the largest part
    row.plan.assembly.parts.erase(row.plan.assembly.parts.begin());
    const auto add_step = [&](const std::string& name, const Pose& from, const Eigen::Vector3d& by, bool leaves) {
      PlanStep step;
      step.step = static_cast<unsigned>(row.plan.disassembly.size() + 1);
      step.moves = {{name, {from, Pose{from.t + by, from.q}}}};
      if (leaves) step.separates = {{name}};
      row.plan.disassembly.push_back(step);
    };
    const Pose aside{{0, 2, 0}, Eigen::Quaterniond::Identity()};
    for (std::size_t i = 0; i < 4; ++i) {
      Part& part = row.assembly.parts[i];
      part.id = row.plan.assembly.parts[i].id = static_cast<PartId>(i);
      part.name = row.plan.assembly.parts[i].name = "post#" + std::to_string(i + 1);
      const double x = 3.0 * double(i);
      part.mesh = part.surface = std::make_shared<Mesh>(shapes::box({x, 0, 0}, {x + 1, 1, 2}));
    }
    if (displaced) add_step("post#3", Pose{}, aside.t, false);
    for (std::size_t i = 0; i < 3; ++i)
      add_step(row.assembly.parts[i].name, displaced && i == 2 ? aside : Pose{}, {0, 0, 5}, true);
    std::vector<BookChapter> chapters = instructions(row.plan, row.assembly, true);
    join_equal_steps(chapters, row.plan, row.assembly, items_of(row));
    std::vector<std::size_t> pages;
    for (const BookStep& step : chapters.at(0).steps) pages.push_back(1 + step.joined.size());
    EXPECT_EQ(pages, displaced ? std::vector<std::size_t>({1, 1, 1, 1}) : std::vector<std::size_t>{3});
  }
}

TEST(EqualSteps, APageSaysHowManyAndHasThePlacesOfAllNumbers) {
  std::mt19937 random(7);
  Row row = row_on_plate(random, 4);
  for (std::size_t s = 0; s < 4; ++s) {  // four posts, all lifted
    const std::string name = "post#" + std::to_string(s + 1);
    Part& part = row.assembly.parts[s + 1];
    const double x = 3.0 * double(s);
    part.mesh = part.surface = std::make_shared<Mesh>(shapes::box({x, 0, 0}, {x + 1, 1, 2}));
    part.name = row.plan.assembly.parts[s + 1].name = name;
    row.plan.disassembly[s].moves = {{name, {Pose{}, Pose{{0, 0, 5}, Eigen::Quaterniond::Identity()}}}};
    row.plan.disassembly[s].separates = {{name}};
  }
  row.plan.disassembly[1].checks.push_back(
      {.type = "gravity", .notes = {{"hold", "Hold 'base'.", R"({"hold": [{"part": "base"}]})"}}});
  BookOptions options;
  options.notes = {{{"post#2"}, "Grease it."}};
  const std::string html = book_html(row.plan, row.assembly, options);
  EXPECT_NE(html.find("step 1–4 of 4"), std::string::npos);
  EXPECT_NE(html.find("4 × post</div>"), std::string::npos);
  for (int number = 1; number <= 4; ++number)
    EXPECT_NE(html.find("id=\"step-" + std::to_string(number) + "\""), std::string::npos);
  EXPECT_NE(html.find("<dd>(1 / 4) Hold &#39;base&#39;.</dd>"), std::string::npos)
      << html.substr(html.find("<dt>hold"), 90);
  EXPECT_NE(html.find("post#2: Grease it."), std::string::npos);
}

TEST(EqualSteps, FactsAreSaidOnceWithTheNamesOfTheItems) {
  const auto item = [](const std::string& part) { return part.substr(0, part.find('#')); };
  const std::vector<Facts> each{{{"tool", "Turn 'bolt#1' by hand."}, {"order", "first"}},
                                {{"tool", "Turn 'bolt#2' by hand."}, {"order", "second"}, {"hold", "Hold 'lid#9'."}},
                                {{"tool", "Turn 'bolt#3' by hand."}, {"hold", "Hold 'lid#8'."}}};
  const Facts all{{"tool", "Turn 'bolt' by hand."}, {"order", "first"}, {"hold", "(2 / 3) Hold 'lid'."}};
  EXPECT_EQ(facts_of_all(each, "order", item), all);
  EXPECT_EQ(facts_of_all({each[1]}, "order", item), each[1]) << "a single step keeps its words";
}

// A name that different items share does not tell them apart: their kinds and sizes do.
TEST(EqualSteps, PagesCallItemsOfOneNameByTheirSize) {
  std::mt19937 random(8);
  Row row = row_on_plate(random, 4);
  for (std::size_t s = 0; s < 4; ++s) {
    const std::string name = "Document#" + std::to_string(s + 1);
    row.assembly.parts[s + 1].name = row.plan.assembly.parts[s + 1].name = name;
    const double x = 3.0 * double(s), height = s < 2 ? 1 : 2;
    row.assembly.parts[s + 1].mesh = row.assembly.parts[s + 1].surface =
        std::make_shared<Mesh>(shapes::box({x, 0, 0}, {x + 1, 1, height}));
    row.plan.disassembly[s].moves[0].part = name;
    row.plan.disassembly[s].separates = {{name}};
    if (s < 2) row.plan.assembly.parts[s + 1].kind = PartKind{"screw", "M5x20", 1};
  }
  std::string html = book_html(row.plan, row.assembly, {});
  EXPECT_NE(html.find("screw M5x20</div>"), std::string::npos);
  EXPECT_NE(html.find("Document#3</div>"), std::string::npos) << "what is not recognised";
  row.assembly.parts[0].name = row.plan.assembly.parts[0].name = "plate";
  for (std::size_t s = 0; s < 2; ++s) {
    const std::string name = "bolt#" + std::to_string(s + 1);
    row.assembly.parts[s + 1].name = row.plan.assembly.parts[s + 1].name = row.plan.disassembly[s].moves[0].part = name;
    row.plan.disassembly[s].separates = {{name}};
  }
  html = book_html(row.plan, row.assembly, {});
  EXPECT_NE(html.find("bolt (M5x20)</div>"), std::string::npos);
}

}  // namespace
}  // namespace dismantle
