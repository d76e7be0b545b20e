// Law: the plan of something that has to be held proves its holds; a plan whose proof was changed is not valid; one
// without proofs is.
#include <gtest/gtest.h>

#include <functional>

#include "dismantle/samples/samples.h"
#include "dismantle/session/session.h"

namespace dismantle {
namespace {

class HoldProofs : public ::testing::Test {
 protected:
  HoldProofs() {
    const LoadedAssembly loaded = session_.load(InputParts{samples::make("arch"), "", {}, {}}, "arch");
    assembly_ = *loaded.assembly;
    plan_ = session_.plan(loaded).plan;
  }

  PlanVerdict& verdict(Plan& plan, PlanStep& step) const {
    for (std::size_t c = 0; c < plan.objective.checks.size(); ++c)
      if (plan.objective.checks[c].type == "gravity") return step.checks.at(c);
    throw std::logic_error("the plan was not judged by gravity");
  }

  /// How many steps with `name` in their proof are found to be wrong when it is changed.
  void every_change_is_found(const std::string& name, const std::function<bool(std::vector<double>&)>& change) {
    std::size_t changed = 0;
    for (std::size_t k = 0; k < plan_.disassembly.size(); ++k) {
      Plan other = plan_;
      PlanStep& step = other.disassembly[k];
      auto& proof = verdict(other, step).certificate;
      if (!proof || !proof->numbers.contains(name) || !change(proof->numbers.at(name))) continue;
      ++changed;
      const PlanCheck check = session_.verify(other, assembly_);
      ASSERT_FALSE(check.valid) << name << " of step " << step.step;
      EXPECT_NE(check.problems.at(0).message.find("proof"), std::string::npos) << check.problems[0].message;
      EXPECT_EQ(check.problems[0].step, step.step);
    }
    EXPECT_GT(changed, 0u) << name;
  }

  Session session_{{{}, {"run.threads=1"}, {}}};
  Assembly assembly_;
  Plan plan_;
};

TEST_F(HoldProofs, AreRightAndMayBeMissing) {
  EXPECT_TRUE(session_.verify(plan_, assembly_).valid);
  std::size_t held = 0;
  for (PlanStep& step : plan_.disassembly) {
    PlanVerdict& stated = verdict(plan_, step);
    ASSERT_TRUE(stated.certificate) << step.step;
    held += stated.certificate->numbers.at("during.held").size();
    stated.certificate.reset();
  }
  EXPECT_GT(held, 0u);
  EXPECT_TRUE(session_.verify(plan_, assembly_).valid);
}

TEST_F(HoldProofs, DoNotSurviveAChange) {
  every_change_is_found("during.held", [](std::vector<double>& held) {
    const bool any = !held.empty();
    held.clear();
    return any;
  });
  every_change_is_found("during.displacement", [](std::vector<double>& numbers) {
    for (double& x : numbers) x *= 1.001;
    return !numbers.empty();
  });
  every_change_is_found("during.falls", [](std::vector<double>& falls) {
    const bool any = !falls.empty();
    falls.clear();
    return any;
  });
  every_change_is_found("during.falls", [](std::vector<double>& falls) {
    for (std::size_t k = 2; k < falls.size(); ++k) falls[k] = -falls[k];
    return !falls.empty();
  });
}

}  // namespace
}  // namespace dismantle
