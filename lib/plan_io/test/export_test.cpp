// Motions in words, and the texts and graphs that are made of plans.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <set>
#include <sstream>

#include "dismantle/errors.h"
#include "dismantle/geometry/length_unit.h"
#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/exports.h"
#include "dismantle/plan_io/input_frame.h"
#include "dismantle/plan_io/motion_words.h"
#include "dismantle/plan_io/summary.h"
#include "random_disassembly.h"

namespace dismantle {
namespace {

using ExportJson = nlohmann::json;

const Eigen::Vector3d kY = Eigen::Vector3d::UnitY(), kZ = Eigen::Vector3d::UnitZ();

/// Every axis both ways, and a direction that is none.
std::vector<Eigen::Vector3d> drawn_ups() {
  std::vector<Eigen::Vector3d> out{Eigen::Vector3d(0.48, 0.6, -0.64)};
  for (int k = 0; k < 3; ++k)
    for (const double sign : {1.0, -1.0}) out.emplace_back(sign * Eigen::Vector3d::Unit(k));
  return out;
}

TEST(Exports, TheAndOrGraphIsATreeDownToTheParts) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 30; ++trial) {
    const auto [plan, assembly] = random_disassembly(random, 2 + trial % 10);
    const ExportJson graph = ExportJson::parse(and_or_json(plan));
    const std::size_t n = plan.assembly.parts.size();
    EXPECT_EQ(graph["nodes"].size(), 2 * n - 1);
    EXPECT_EQ(graph["arcs"].size(), n - 1);
    std::set<std::size_t> reached{0};
    for (const ExportJson& arc : graph["arcs"]) {
      EXPECT_TRUE(reached.contains(arc["from"].get<std::size_t>())) << "arcs come in the order of the steps";
      std::size_t parts = 0;
      for (const ExportJson& to : arc["to"]) {
        EXPECT_TRUE(reached.insert(to.get<std::size_t>()).second);
        parts += graph["nodes"][to.get<std::size_t>()]["parts"].size();
      }
      EXPECT_EQ(parts, graph["nodes"][arc["from"].get<std::size_t>()]["parts"].size());
    }
    EXPECT_EQ(reached.size(), graph["nodes"].size());
  }
}

TEST(Exports, PosesHaveTheTimesOfTheAnimation) {
  std::mt19937 random(3);
  const auto [plan, assembly] = random_disassembly(random, 6);
  const ExportJson poses = ExportJson::parse(poses_json(plan, assembly, input_frame(plan.assembly)));
  ASSERT_EQ(poses["disassembly"].size(), plan.disassembly.size());
  EXPECT_TRUE(poses["unit"].is_null());
  double before = 0;
  std::size_t rows = 0;
  for (std::size_t s = 0; s < plan.disassembly.size(); ++s) {
    const ExportJson& step = poses["disassembly"][s];
    EXPECT_GT(step["times"].front().get<double>(), before) << "steps follow each other";
    before = step["times"].back().get<double>();
    EXPECT_GE(before - step["times"].front().get<double>(), 1 - 1e-5) << "a step takes a second or more";
    for (std::size_t m = 0; m < step["moves"].size(); ++m) {
      EXPECT_EQ(step["moves"][m]["poses"].size(), step["times"].size());
      EXPECT_EQ(step["moves"][m]["poses"].back()[2], plan.disassembly[s].moves[m].poses.back().t.z());
      rows += step["times"].size();
    }
  }
  const std::string csv = poses_csv(plan, assembly);
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(csv, '\n')), 1 + rows);
  EXPECT_NE(csv.find("\"p,\"\""), std::string::npos) << "quotes are doubled";
  EXPECT_EQ(csv, poses_csv(plan, assembly));
}

TEST(Exports, GraphsOfStepsHaveEveryStepAndEveryReason) {
  std::mt19937 random(4);
  auto [plan, assembly] = random_disassembly(random, 7);
  const auto count = [](const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
  };
  const std::string xml = step_order_graphml(plan), dot = step_order_dot(plan);
  EXPECT_EQ(count(xml, "<node id="), plan.disassembly.size());
  EXPECT_EQ(count(xml, "<edge source="), plan.disassembly.size() - 1);
  EXPECT_EQ(count(dot, "[label="), plan.disassembly.size());
  EXPECT_EQ(count(dot, " -> "), plan.disassembly.size() - 1 + 1) << "and the comment";
  plan.disassembly[0].layer = 0;
  EXPECT_THROW(step_order_graphml(plan), InputError) << "a plan that does not say must not look as if nothing waited";
  EXPECT_THROW(step_order_dot(plan), InputError);
}

TEST(Exports, MarkdownHasARowPerStepAndNoMarkupOfNames) {
  std::mt19937 random(5);
  const auto [plan, assembly] = random_disassembly(random, 5);
  std::istringstream lines(steps_markdown(plan, input_frame(plan.assembly)));
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line) && !line.starts_with("<details>");) {
    if (!line.starts_with("| ") || line.starts_with("| step")) continue;
    ++rows;
    std::size_t bars = 0;
    for (std::size_t i = 0; i < line.size(); ++i) bars += line[i] == '|' && (i == 0 || line[i - 1] != '\\');
    EXPECT_EQ(bars, 7u) << line;
    EXPECT_NE(line.find("2 units up"), std::string::npos) << line;
  }
  EXPECT_EQ(rows, plan.disassembly.size());
}

TEST(Exports, HowGoodStepsWereFoundIsADetail) {
  std::mt19937 random(5);
  auto [plan, assembly] = random_disassembly(random, 5);
  for (PlanStep& step : plan.disassembly) {
    step.planner = "guided";
    step.seconds = 17.25;
    step.max_penetration = 0.0013;
  }
  const auto count = [](const std::string& text, const std::string& word) {
    std::size_t n = 0;
    for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; ++at) ++n;
    return n;
  };
  const std::size_t steps = plan.disassembly.size();
  const std::string plain = summary_text(plan), details = summary_text(plan, true);
  for (const char* word : {"17.25", "penetration"}) EXPECT_EQ(count(plain, word), 0u) << plain;
  EXPECT_NE(plain.find("every step is verified\n"), std::string::npos) << plain;
  EXPECT_EQ(count(details, "17.25 s  penetration <= "), steps) << details;
  EXPECT_NE(details.find("every step is verified: penetration <= "), std::string::npos) << details;

  const std::string markdown = steps_markdown(plan, {});
  const std::size_t fold = markdown.find("\n<details>");
  ASSERT_NE(fold, std::string::npos);
  for (const char* word : {"cuts in", "guided", "17.25"}) EXPECT_EQ(count(markdown.substr(0, fold), word), 0u) << word;
  EXPECT_EQ(count(markdown.substr(fold), "| guided | 0 | 17.25 | 0.0013 |\n"), steps) << markdown;
  plan.disassembly[1].forced.emplace().depth = 0.5;
  const std::string forced = steps_markdown(plan, {});
  EXPECT_EQ(count(forced.substr(0, forced.find("\n<details>")), "| **forced: 0.5 units** |"), 1u) << forced;
  EXPECT_EQ(count(summary_text(plan), "FORCED"), 1u);
}

TEST(Exports, MarkdownSaysWhyEachForcedStepIsForced) {
  std::mt19937 random(5);
  auto [plan, assembly] = random_disassembly(random, 5);
  EXPECT_EQ(steps_markdown(plan, {}).find("forced"), std::string::npos);
  plan.disassembly[2].forced = PlanForced{.part = "hook", .other = "rim", .depth = 1, .reason = "it <snaps>"};
  const std::string numbers = "Step 3 (" + std::to_string(plan.disassembly.size() - 2) + " in assembly)";
  EXPECT_NE(steps_markdown(plan, {}).find("constraints: {accept: "), std::string::npos);
  EXPECT_NE(steps_markdown(plan, {}).find("- " + numbers + " cuts hook into rim: it \\<snaps\\>; "), std::string::npos);
}

TEST(MotionWords, LegsOfAPathAreFoundAgain) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Pose> poses{Pose{}};
    std::vector<Eigen::Vector3d> stretches;
    for (int l = 0; l < 3; ++l) {
      Eigen::Vector3d stretch = Eigen::Vector3d::Zero();
      stretch[(trial + l) % 3] = 5 + 3 * any(random);
      for (int k = 1; k <= 20; ++k) poses.push_back({poses.back().t + stretch / 20, Eigen::Quaterniond::Identity()});
      stretches.push_back(stretch);
    }
    const MotionSummary motion = summarize_motion(poses, {any(random), 0, 0}, 0.05);
    ASSERT_EQ(motion.stretches.size(), 3u);
    double length = 0;
    for (int l = 0; l < 3; ++l) {
      EXPECT_LT((motion.stretches[static_cast<std::size_t>(l)] - stretches[static_cast<std::size_t>(l)]).norm(), 1e-9);
      length += stretches[static_cast<std::size_t>(l)].norm();
    }
    EXPECT_NEAR(motion.length, length, 1e-9);
    EXPECT_EQ(motion.turn, 0);
  }
}

TEST(MotionWords, AScrewIsToldByItsTurnsAndItsSense) {
  for (const double turns : {0.25, 1.5, 7.0})
    for (const int hand : {1, -1}) {
      std::vector<Pose> poses;
      for (int k = 0; k <= 100; ++k) {
        const double u = k / 100.0;
        poses.push_back({{0, 0, -3 * u},
                         Eigen::Quaterniond(
                             Eigen::AngleAxisd(-hand * 2 * std::numbers::pi * turns * u, Eigen::Vector3d::UnitZ()))});
      }
      const MotionSummary motion = summarize_motion(poses, {0, 0, 1}, 0.01);
      EXPECT_NEAR(motion.turn, 2 * std::numbers::pi * turns, 1e-9);
      const std::string words = motion_words(motion, "mm", kZ);
      // A right-hand screw that goes in turns clockwise when seen along its motion.
      EXPECT_NE(words.find(hand > 0 ? " clockwise" : "counter-clockwise"), std::string::npos) << words;
      EXPECT_EQ(words.find("3 mm down (-Z)"), 0u) << words;
    }
}

/// A screw far from the middle of its assembly moves by its pitch, not along a long helix.
TEST(MotionWords, AScrewIsMeasuredOnItsAxis) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const auto point = [&] { return Eigen::Vector3d(any(random), any(random), any(random)); };
    const Eigen::Vector3d axis = point().normalized(), through = 40 * point();
    const Pose first{5 * point(), Eigen::Quaterniond::UnitRandom()};
    const double turns = 0.2 + 3 * std::abs(any(random)), travel = 3 * any(random);
    std::vector<Pose> poses;
    for (int k = 0; k <= 200; ++k) {
      const double u = k / 200.0;
      const Eigen::Quaterniond q(Eigen::AngleAxisd(2 * std::numbers::pi * turns * u, axis));
      const Pose screw{through - q * through + travel * u * axis, q};
      poses.push_back({screw.q * first.t + screw.t, screw.q * first.q});
    }
    const MotionSummary motion = summarize_motion(poses, point_on_axis(poses, 10 * point()), 0.01);
    EXPECT_NEAR(motion.length, std::abs(travel), 1e-6);
    EXPECT_NEAR(motion.turn, 2 * std::numbers::pi * turns, 1e-6);
  }
  EXPECT_EQ(point_on_axis({Pose{}, Pose{{1, 2, 3}, Pose{}.q}}, {4, 5, 6}), Eigen::Vector3d(4, 5, 6));
}

/// The slides of a puzzle are all told, at any orientation; a bent path with as many stretches is not.
TEST(MotionWords, SlidesAreToldOneByOne) {
  Rng rng(5);
  for (const bool slides : {true, false})
    for (int trial = 0; trial < 10; ++trial) {
      const Eigen::Quaterniond turned =
          Eigen::Quaterniond(rng.normal(), rng.normal(), rng.normal(), rng.normal()).normalized();
      std::vector<Pose> poses{Pose{}};
      const int stretches = 7;
      for (int k = 0; k < stretches; ++k) {
        Eigen::Vector3d stretch = (1 + k) * Eigen::Vector3d::Unit(k % 3);
        if (!slides) stretch[(k + 1) % 3] = 0.5 * k;
        poses.push_back({poses.back().t + turned * stretch, Pose{}.q});
      }
      const std::string words = motion_words(summarize_motion(poses, {0, 0, 0}, 1e-3), "mm", kZ);
      std::size_t told = 1;
      for (std::size_t at = words.find(", then "); at != std::string::npos; at = words.find(", then ", at + 1)) ++told;
      EXPECT_EQ(told, slides ? stretches : 1) << words;
    }
}

TEST(MotionWords, DirectionsAreThoseOfSomeoneBeforeTheAssembly) {
  EXPECT_EQ(direction_words({0, 0, 2}, kZ), "up (+Z)");
  EXPECT_EQ(direction_words({0, 2, 0}, kY), "up (+Y)");
  EXPECT_EQ(direction_words({0, -1, 0}, kZ), "to the front (-Y)");
  EXPECT_EQ(direction_words({0, 0, 1}, kY), "to the front (+Z)");
  EXPECT_EQ(direction_words({-1, 0, -1}, kZ), "down and left (-0.71, 0, -0.71)");
  EXPECT_THROW(direction_words({0, 0, 0}, kZ), Error);
  EXPECT_EQ(lie_words({0, 0, -1}, kZ), "upside down (-Z up)");
  EXPECT_EQ(lie_words({1, 0, 0}, kZ), "on its left side (+X up)");
  EXPECT_EQ(lie_words({0, 1, 0}, kZ), "on its front (+Y up)");
  EXPECT_EQ(lie_words({0, 0, 1}, kY), "on its back (+Z up)");
  EXPECT_EQ(direction_words({1, 0, 0}, -kZ), "right (+X)") << "upside down over the front";
  EXPECT_EQ(direction_words({0, 1, 0}, -kZ), "to the front (+Y)");
  EXPECT_EQ(direction_words({1, 0, 0}, Eigen::Vector3d::UnitX()), "up (+X)");
  EXPECT_EQ(lie_words({0, 0, 1}, -kZ), "upside down (+Z up)");
  // Law: right, back and up of a person are a right-handed frame of the input, whatever is up.
  for (const Eigen::Vector3d& drawn : drawn_ups()) {
    const Eigen::Quaterniond input = upright(drawn).conjugate();
    EXPECT_LT((input * kZ - drawn).norm(), 1e-12);
    EXPECT_TRUE(direction_words(drawn, drawn).starts_with("up ("));
    EXPECT_TRUE(direction_words(input * Eigen::Vector3d::UnitX(), drawn).starts_with("right ("));
    EXPECT_TRUE(direction_words(input * kY, drawn).starts_with("to the back ("));
    InputFrame frame;
    frame.up = drawn;
    EXPECT_LT((frame.to_y_up() * drawn - kY).norm(), 1e-12) << "glTF has Y up";
  }
  // Law: what is put in against the upward direction of the step goes down, for any orientation.
  for (const Eigen::Vector3d& drawn : drawn_ups()) {
    InputFrame frame;
    frame.up = drawn;
    Rng rng(3);
    for (int n = 0; n < 50; ++n) {
      Eigen::Vector3d up = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
      if (n < 6) up = (n % 2 == 0 ? 1 : -1) * Eigen::Vector3d::Unit(n / 2);
      const std::string words = direction_words(-up, drawn, frame.lies(up));
      EXPECT_EQ(words.substr(0, 6), "down (") << words;
    }
  }
}

TEST(InputFrame, TextsUseTheUnitOfPeople) {
  const auto box = [](double size) { return Aabb{{0, 0, 0}, {size, size / 2, size / 3}}; };
  EXPECT_EQ(text_unit("m", box(0.3)).name, "mm");
  EXPECT_EQ(text_unit("m", box(0.3)).factor, 1000);
  EXPECT_EQ(text_unit("micron", box(20)).name, "um");
  EXPECT_EQ(text_unit("inch", box(3)).factor, 1);
  EXPECT_EQ(text_unit("", box(3)).name, "");
  EXPECT_EQ(text_unit("ell", box(3)).name, "ell");
  Plan plan;
  plan.assembly.unit = "m";
  plan.assembly.box = box(0.3);
  EXPECT_EQ(length_text(plan, 0.0358), "35.8 mm");
  EXPECT_EQ(length_text(plan, 1.2344), "1234 mm") << "without an exponent";
  const InputFrame inch = shown_in(input_frame(plan.assembly), "inches");
  EXPECT_EQ(length_text(text_unit(inch, plan.assembly.box), 0.0254), "1 inch");
  EXPECT_THROW(shown_in(input_frame(plan.assembly), "ell"), InputError);
  EXPECT_THROW(shown_in(input_frame(PlanAssembly{}), "mm"), InputError) << "of an input without a unit";
  plan.assembly.parts.push_back({0, "a", "a.stl"});
  PlanStep step;
  step.step = 1;
  step.forced = PlanForced{.part = "a", .other = "b", .depth = 0.0254, .assembled = 0.00254, .reason = ""};
  step.moves = {{"a", {Pose{}, Pose{{0, 0, 0.0508}, {1, 0, 0, 0}}}}};
  step.separates = {{"a"}};
  plan.disassembly = {step};
  const std::string cuts = "a cuts 1 inch into b (0.1 inch when assembled)";
  EXPECT_NE(summary_text(plan, false, text_unit(inch, plan.assembly.box)).find(cuts), std::string::npos);
  EXPECT_NE(explain_text(explain(plan, {}), text_unit(inch, plan.assembly.box)).find(cuts), std::string::npos);
  EXPECT_NE(steps_markdown(plan, inch).find("2 inch up"), std::string::npos);
  EXPECT_NE(steps_csv(plan, inch).find(",inch,"), std::string::npos);
  const MotionSummary motion =
      in_unit(summarize_motion({Pose{}, Pose{{0, 0, -0.0358}, {1, 0, 0, 0}}}, {0, 0, 0}, 1e-3), 1000);
  EXPECT_EQ(motion_words(motion, "mm", kZ), "35.8 mm down (-Z)");
}

TEST(InputFrame, UnitsOfImportersAreKnownAndOthersNamed) {
  EXPECT_EQ(metres_in("inch"), 0.0254);
  EXPECT_THROW(metres_in("ell"), InputError);
  PlanAssembly a;
  EXPECT_EQ(input_frame(a).unit, "mm");
  a.parts = {{0, "a", "a.GLB", {}, {}}};
  EXPECT_EQ(input_frame(a).up, kY);
  EXPECT_EQ(input_frame(a).metres, 1);
  a.parts.push_back({1, "b", "b.stl", {}, {}});
  EXPECT_EQ(input_frame(a).up, kZ);
}

TEST(Summary, SaysOfAPuzzleWhereToAndHowFarEachPieceGoes) {
  Plan plan;
  plan.assembly.box = {{0, 0, 0}, {4, 4, 4}};
  for (const char* name : {"key", "lock"}) plan.assembly.parts.push_back({0, name, std::string(name) + ".obj"});
  const auto at = [](double x, double y, double z) {
    return Pose{Eigen::Vector3d(x, y, z), Eigen::Quaterniond::Identity()};
  };
  PlanStep shifted, out;
  shifted.step = 1;
  shifted.moves = {{"key", {at(0, 0, 0), at(2, 0, 0), at(2, 0, 1)}}};
  out.step = 2;
  out.moves = {{"lock", {at(0, 0, 0), at(0, 0, -5)}}};
  out.separates = {{"lock"}, {"key"}};
  plan.disassembly = {shifted, out};
  const std::string text = summary_text(plan);
  EXPECT_NE(text.find("2 units right (+X), then 1 units up (+Z), and stays there\n"), std::string::npos) << text;
  EXPECT_NE(text.find("5 units down (-Z)\n"), std::string::npos) << text;
  plan.disassembly = {out};
  EXPECT_EQ(summary_text(plan).find("down"), std::string::npos) << "nothing is only shifted";
}

}  // namespace
}  // namespace dismantle
