/// Judges a whole plan file against the assembly that it is for.
#pragma once

#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

struct PlanProblem {
  unsigned step = 0;  ///< 0 = the plan as a whole
  std::string message;
};

struct PlanCheck {
  bool valid = false;     ///< rules (a), (b), (c) of DESIGN section 7 hold for every step
  bool complete = false;  ///< valid, and every group is down to one part
  double max_penetration = 0;  ///< worst certified bound over all steps
  std::vector<double> step_penetration;
  std::vector<PlanProblem> problems;
};

DISMANTLE_API PlanCheck check_plan(const Plan& plan, const Assembly& assembly, const VerifyOptions& options,
                                   RunContext& context);

}  // namespace dismantle
