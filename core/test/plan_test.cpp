// The meaning of success: is_done() and Plan::succeeded().
#include "dismantle/plan.h"

#include <gtest/gtest.h>

namespace dismantle {
namespace {

TEST(PlanAsked, AWholeAssemblyIsDoneWhenEveryPartIsAlone) {
  EXPECT_TRUE(is_done({}, {{"a"}, {"b"}, {"c"}}));
  EXPECT_FALSE(is_done({}, {{"a"}, {"b", "c"}}));
  EXPECT_TRUE(is_done({}, {{"a"}, {}})) << "a group of no part is a step that separated nothing";
}

TEST(PlanAsked, PartsThatStayTogetherCountAsOne) {
  const PlanAsked asked{.together = {{"a", "b"}, {"b", "c"}}};
  EXPECT_TRUE(is_done(asked, {{"a", "b", "c"}, {"d"}})) << "lists that share a part are one";
  EXPECT_TRUE(is_done(asked, {{"c", "a"}, {"b"}, {"d"}}));
  EXPECT_FALSE(is_done(asked, {{"a", "b", "c", "d"}}));
}

TEST(PlanAsked, ATargetIsOutWhenItsGroupIsDone) {
  for (const PlanAsked& asked : {PlanAsked{.target = "b"}, PlanAsked{.part = "b"}}) {
    EXPECT_TRUE(is_done(asked, {{"a", "c"}, {"b"}}));
    EXPECT_FALSE(is_done(asked, {{"a", "b"}, {"c"}}));
  }
  EXPECT_TRUE(is_done({.target = "b", .together = {{"b", "c"}}}, {{"a", "d"}, {"b", "c"}}));
  EXPECT_FALSE(is_done({.target = "b", .together = {{"b", "c"}}}, {{"a"}, {"b", "c", "d"}}));
}

TEST(PlanAsked, APartThatCouldNotBeUsedIsNoSuccessUnlessAnotherOneWasAskedFor) {
  Plan plan;
  plan.status = PlanStatus::complete;
  EXPECT_TRUE(plan.succeeded());
  plan.assembly.excluded = {{"foil", "too thin", false}};
  EXPECT_TRUE(plan.succeeded());
  plan.assembly.excluded.push_back({"sheet", "not watertight", true});
  EXPECT_FALSE(plan.succeeded());
  plan.asked.part = "a";
  EXPECT_TRUE(plan.succeeded());
  for (const PlanStatus status : {PlanStatus::forced, PlanStatus::partial}) {
    plan.status = status;
    EXPECT_FALSE(plan.succeeded());
  }
}

}  // namespace
}  // namespace dismantle
