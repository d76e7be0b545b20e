/// Is what a plan says of depths true? Measured again, along the whole motion.
#pragma once

#include <optional>
#include <string>

#include "dismantle/plan.h"
#include "dismantle/verification/motion_depth.h"
#include "plan/plan_state.h"

namespace dismantle {

class DepthStatements {
 public:
  /// All outlive it.
  DepthStatements(const Assembly& assembly, const Verifier& verifier, const PlanState& state, const RunContext& context)
      : assembly_(assembly), verifier_(verifier), state_(state), context_(context), meter_(assembly, verifier) {}

  /// What is wrong with what is said of a forced motion past `fixed`; nothing when it holds.
  std::optional<std::string> wrong(const PlanForced& said, const StepMotion& motion,
                                   const std::vector<PlacedPart>& fixed);
  /// The same of a pair that a step moves past each other, the others being where they are.
  std::optional<std::string> wrong(const PlanStepOverlap& said, const StepMotion& motion);
  /// The same of the parts that the plan takes for flexible by their shape, measured again when the assembly was made.
  std::optional<std::string> wrong_flexible(const PlanAssembly& said) const;

 private:
  bool agrees(double stated, double measured) const;

  const Assembly& assembly_;
  const Verifier& verifier_;
  const PlanState& state_;
  const RunContext& context_;
  MotionDepthMeter meter_;
};

}  // namespace dismantle
