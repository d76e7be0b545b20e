/// Step check: how many steps are there?
#pragma once

#include "dismantle/step_check.h"

namespace dismantle::checks {

/// Each step costs 1.
class Steps final : public StepCheck {
 public:
  StepCheckTraits traits() const noexcept override { return {.reads_present = false, .reads_path = false}; }
  StepVerdict judge(const StepQuestion& /*question*/, const RunContext& /*context*/) const override {
    StepVerdict verdict;
    verdict.cost = 1;
    verdict.reason = "one more step";
    return verdict;
  }
};

}  // namespace dismantle::checks
