/// Checks the depths that a plan states, by measuring again along the whole motion.
#pragma once

#include <optional>
#include <string>

#include "dismantle/plan.h"
#include "dismantle/verification/motion_depth.h"
#include "plan/plan_state.h"

namespace dismantle {

class DepthStatements {
 public:
  /// All arguments must outlive it.
  DepthStatements(const Assembly& assembly, const Verifier& verifier, const PlanState& state, const RunContext& context)
      : assembly_(assembly), verifier_(verifier), state_(state), context_(context), meter_(assembly, verifier) {}

  /// Checks the stated depth of a forced motion past `fixed`. Returns the error; nullopt when the statement holds.
  /// `measured`: set to the depth, assembly units.
  std::optional<std::string> wrong(const PlanForced& said, const StepMotion& motion,
                                   const std::vector<PlacedPart>& fixed, double& measured);
  /// Is the motion valid up to the pose that the step states?
  std::optional<std::string> wrong_valid_to(const PlanStep& said, const StepMotion& motion,
                                            const std::vector<PlacedPart>& fixed) const;
  /// The same for a pair that a step moves past each other, with the other part at its current place. `held`: parts
  /// past which the motion has been verified, which bounds the depth of their pairs.
  std::optional<std::string> wrong(const PlanStepOverlap& said, const StepMotion& motion,
                                   const std::vector<PartId>& held);
  /// The same for the parts that the plan takes for flexible by their file or shape, compared with the measurement made
  /// for the assembly.
  std::optional<std::string> wrong_flexible(const PlanAssembly& said) const;

 private:
  /// `absolute`: error that is always allowed; assembly units.
  bool agrees(double stated, double measured, double absolute) const;

  const Assembly& assembly_;
  const Verifier& verifier_;
  const PlanState& state_;
  const RunContext& context_;
  MotionDepthMeter meter_;
};

}  // namespace dismantle
