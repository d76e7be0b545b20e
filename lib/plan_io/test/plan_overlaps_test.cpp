// Overlaps in plan.json: they round-trip, and errors name their location.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "dismantle/errors.h"
#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/thread_words.h"
#include "dismantle/run_context.h"

namespace dismantle {
namespace {

Eigen::Vector3d any_point(Rng& rng) { return {rng.normal(), rng.normal(), rng.normal()}; }

Plan plan_with(std::vector<PlanOverlap> overlaps) {
  Plan plan;
  plan.generator_version = "0.1.0";
  plan.assembly.parts = {{0, "peg", "peg.obj"}, {1, "hole", "hole.obj"}};
  plan.assembly.overlaps = std::move(overlaps);
  plan.remaining = {"peg", "hole"};
  return plan;
}

OverlapPlace any_place(Rng& rng) {
  OverlapPlace place;
  place.contact = static_cast<ContactClass>(rng.below(6));
  place.at = any_point(rng);
  place.region.extend(place.at);
  place.region.extend(any_point(rng));
  place.share = rng.uniform();
  if (rng.below(2) == 0) {
    place.axis = any_point(rng).normalized();
    place.axis_point = any_point(rng);
  }
  return place;
}

TEST(PlanOverlaps, AreReadAsTheyWereWritten) {
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    PlanOverlap written{"peg", "hole", rng.uniform()};
    if (i % 4 != 0) written.place = any_place(rng);
    if (i % 3 == 0) written.flexible = true;
    const Plan read = plan_from_json(to_json(plan_with({written})), "plan.json");
    ASSERT_EQ(read.assembly.overlaps.size(), 1u);
    const PlanOverlap& o = read.assembly.overlaps.front();
    EXPECT_EQ(o.a, written.a);
    EXPECT_EQ(o.b, written.b);
    EXPECT_EQ(o.depth, written.depth);
    EXPECT_EQ(o.flexible, written.flexible);
    ASSERT_EQ(o.place.has_value(), written.place.has_value());
    if (!o.place) continue;
    EXPECT_EQ(o.place->contact, written.place->contact);
    EXPECT_EQ(o.place->at, written.place->at);
    EXPECT_EQ(o.place->region.lo, written.place->region.lo);
    EXPECT_EQ(o.place->region.hi, written.place->region.hi);
    EXPECT_EQ(o.place->share, written.place->share);
    EXPECT_EQ(o.place->axis, written.place->axis);
    EXPECT_EQ(o.place->axis_point, written.place->axis_point);
  }
}

TEST(PlanOverlaps, OfStepsAndFlexiblePartsAreReadAsTheyWereWritten) {
  Rng rng(3);
  for (int i = 0; i < 50; ++i) {
    Plan plan = plan_with({});
    if (i % 4 > 0) plan.assembly.parts[1].flexible = static_cast<Flexible>(i % 4 - 1);
    PlanStep step;
    step.step = 1;
    step.moves = {{"peg", {Pose{}, Pose{any_point(rng), Eigen::Quaterniond::Identity()}}}};
    step.separates = {{"peg"}};
    PlanStepOverlap used{"peg", "hole", rng.uniform(), rng.uniform(), rng.uniform(), {}, {}};
    if (i % 2 == 0) used.at = any_point(rng);
    if (i % 3 == 0) used.region = any_place(rng).region;
    step.overlaps = {used};
    plan.disassembly = {step};
    const Plan read = plan_from_json(to_json(plan), "plan.json");
    EXPECT_EQ(read.assembly.parts[0].flexible, std::nullopt);
    EXPECT_EQ(read.assembly.parts[1].flexible, plan.assembly.parts[1].flexible);
    const PlanStepOverlap& o = read.disassembly.at(0).overlaps.at(0);
    EXPECT_EQ(o.assembled, used.assembled);
    EXPECT_EQ(o.allowed, used.allowed);
    EXPECT_EQ(o.depth, used.depth);
    EXPECT_EQ(o.at, used.at);
    ASSERT_EQ(o.region.has_value(), used.region.has_value());
    if (!o.region) continue;
    EXPECT_EQ(o.region->lo, used.region->lo);
    EXPECT_EQ(o.region->hi, used.region->hi);
  }
}

TEST(PlanOverlaps, WrongOnesAreNamedWithTheirPlace) {
  Rng rng(2);
  PlanOverlap whole{"peg", "hole", 0.1, any_place(rng)};
  whole.place->axis = Eigen::Vector3d::UnitX();
  const auto json = nlohmann::ordered_json::parse(to_json(plan_with({whole})));
  using Json = nlohmann::ordered_json;
  struct Case {
    const char *key, *message;
    Json value;  // null: the key is left out
  };
  const std::vector<Case> cases = {
      {"class", ": 'class' is missing", nullptr},
      {"class", "/class: expected the class of a contact", "tight"},
      {"at", ": 'at' is missing", nullptr},
      {"at", "/at: expected 3 numbers", Json::array({1, 2})},
      {"region", ": 'region' is missing", nullptr},
      {"region", "/region: the first corner is above the second", Json::array({{0, 0, 2}, {1, 1, 1}})},
      {"share", "/share: expected a number between 0 and 1", 1.5},
      {"axis", "/axis: 'direction' is missing", {{"point", {0, 0, 0}}}},
      {"axis", "/axis/direction: expected a vector of length 1", {{"point", {0, 0, 0}}, {"direction", {0, 2, 0}}}},
      {"depth", "/depth: expected a number >= 0", -1},
      {"b", ": a part cannot overlap itself", "peg"},
      {"klass", ": unknown key 'klass'", "inside"},
  };
  for (const Case& c : cases) {
    Json changed = json;
    Json& overlap = changed["assembly"]["overlaps"][0];
    if (c.value.is_null())
      overlap.erase(c.key);
    else
      overlap[c.key] = c.value;
    try {
      plan_from_json(changed.dump(), "plan.json");
      ADD_FAILURE() << "accepted: " << overlap.dump();
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(std::string("/assembly/overlaps/0") + c.message), std::string::npos)
          << e.what();
    }
  }
}

// A screw that is deeper in a part along the way than as assembled cuts its thread; other parts, and others' names, do
// not.
TEST(PlanOverlaps, AScrewThatGoesDeeperCutsItsThread) {
  Plan plan;
  plan.assembly.parts = {{0, "screw", "a.obj"}, {1, "block", "b.obj"}};
  plan.assembly.unit = "mm";
  plan.assembly.box.extend({0, 0, 0});
  plan.assembly.box.extend({10, 10, 10});
  PlanStep step;
  step.overlaps.push_back({"screw", "block", 0.3, 0.5, 0.45});
  EXPECT_TRUE(thread_words(plan, step).empty());  // nothing says that it is a screw
  plan.assembly.parts[0].kind = PartKind{"screw", "M3x10", 1};
  ASSERT_EQ(thread_words(plan, step).size(), 1u);
  EXPECT_EQ(thread_words(plan, step)[0], "'screw' cuts its thread, 0.45 mm deep, into 'block' (0.3 mm when assembled)");
  EXPECT_NE(overlaps_text(plan, step).find("cuts its thread"), std::string::npos);
  step.overlaps[0].part = "block", step.overlaps[0].other = "screw";  // the block moves off the screw
  EXPECT_EQ(thread_words(plan, step)[0], "'screw' cuts its thread, 0.45 mm deep, into 'block' (0.3 mm when assembled)");
  step.overlaps[0].depth = 0.301;
  EXPECT_TRUE(thread_words(plan, step).empty());
}

}  // namespace
}  // namespace dismantle
