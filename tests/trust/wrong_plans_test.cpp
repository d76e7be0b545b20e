// Plans that are wrong, each in another way: all refused, with the reason.
#include <gtest/gtest.h>

#include <functional>

#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle::trust {
namespace {

using shapes::Vec3;

/// A cube between two walls thinner than the step from pose to pose, open above.
class WrongPlans : public testing::Test {
 protected:
  WrongPlans() {
    Mesh walls = shapes::box({-1, -2, -2}, {-0.98, 2, 2});
    shapes::append(walls, shapes::box({0.98, -2, -2}, {1, 2, 2}));
    shapes::append(walls, shapes::box({-5, -2, -2.2}, {5, 2, -2.01}));
    assembly_ = shapes::assembly_of({shapes::box({-0.5, -0.5, -1}, {0.5, 0.5, 1}), walls});
    plan_.status = PlanStatus::complete;
    plan_.verified_max_penetration = 0.01;
    for (const auto& p : assembly_.parts) plan_.assembly.parts.push_back({p.id, p.name, p.file});
    plan_.remaining = {"part1"};
    plan_.disassembly = {along({0, 0, 4})};
  }
  PlanStep along(const Vec3& displacement) const {
    PlanStep step;
    step.step = 1;
    step.moves.push_back({"part0", {}});
    const int n = static_cast<int>(std::ceil(displacement.norm() / 0.09));
    for (int i = 0; i <= n; ++i) step.moves[0].poses.push_back(shapes::shift(displacement * i / n));
    step.separates = {{"part0"}};
    return step;
  }
  std::string problems() const {
    RunContext context;
    const PlanCheck result = check_plan(plan_, assembly_, VerifyOptions{}, context);
    std::string all;
    for (const auto& p : result.problems) all += p.message + "\n";
    EXPECT_EQ(all.empty(), result.valid);
    return all;
  }

  Assembly assembly_;
  Plan plan_;
};

TEST_F(WrongPlans, EachIsRefusedWithItsReason) {
  EXPECT_EQ(problems(), "");
  const Plan good = plan_;
  const auto poses = [this]() -> std::vector<Pose>& { return plan_.disassembly[0].moves[0].poses; };
  const std::vector<std::pair<const char*, std::function<void()>>> wrong = {
      {"from where it is", [&] { poses().front().t.x() += 0.02; }},
      {"travels more than 1 %", [&] { poses().erase(poses().begin() + 10, poses().begin() + 20); }},
      {"penetrates 'part1'",
       [&] {
         plan_.disassembly = {along({4, 0, 0})};
       }},  // no pose lies in the wall
      {"is not out", [&] { poses().resize(12); }},
      {"two moves", [&] { plan_.disassembly[0].moves.push_back(plan_.disassembly[0].moves[0]); }},
      {"listed twice", [&] { plan_.assembly.parts.push_back(plan_.assembly.parts[0]); }},
      {"is not in the plan", [&] { plan_.assembly.parts.pop_back(); }},
      {"is not in the assembly", [&] { plan_.disassembly[0].moves[0].part = "part9"; }},
      {"unit length", [&] { poses()[5].q.coeffs() *= 1.1; }},
      {"several parts left", [&] { plan_.disassembly.clear(); }},
  };
  for (const auto& [reason, change] : wrong) {
    plan_ = good;
    change();
    const std::string found = problems();
    EXPECT_NE(found.find(reason), std::string::npos) << "expected: " << reason << "\nfound: " << found;
  }
}

/// The wall is 0.02 thick, the step 0.09: between two poses on either side of it the cube has passed through.
TEST_F(WrongPlans, AThinWallBetweenTwoPosesIsNoWayOut) {
  for (int k = 1; k < 40; ++k) {
    plan_.disassembly = {along({0.03 * k, 0, 0})};
    auto& step = plan_.disassembly[0];
    step.separates.clear();
    plan_.status = PlanStatus::partial;
    const bool beyond = 0.03 * k > 0.48 + 0.01;
    EXPECT_EQ(problems().empty(), !beyond) << k;
  }
}

/// A file whose text was changed: what is no plan any more says so, what is still one is checked as any other.
TEST_F(WrongPlans, AnEditedFileIsReadAsItStandsOrRefused) {
  plan_.assembly.scale = 1;
  const std::string text = to_json(plan_);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const auto at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return changed.replace(at, from.size(), to);
  };
  EXPECT_NO_THROW(plan_from_json(text, "plan.json"));
  for (const std::string& changed :
       {with("\"version\": 1", "\"version\": 2"), with("\"part\": \"part0\"", "\"part\": \"../part0\""),
        with("\"step\": 1", "\"step\": 2"), with("\"format\": \"dismantle.plan\"", "\"format\": \"other\""),
        with("\"status\": \"complete\"", "\"status\": \"perfect\""), text.substr(0, text.size() / 2)})
    EXPECT_THROW(plan_from_json(changed, "plan.json"), InputError);
}

}  // namespace
}  // namespace dismantle::trust
