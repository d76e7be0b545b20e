/// Judges the steps of a disassembly as assembly operations, by the checks of an objective.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>

#include "dismantle/disassembly.h"
#include "dismantle/export.h"
#include "dismantle/param_value.h"
#include "dismantle/plan.h"
#include "dismantle/run_context.h"
#include "dismantle/step_check.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {

/// Does it prefer some orders to others? An objective whose weights are all 0, without `require`, only measures: plans
/// are the same as without it.
DISMANTLE_API bool prefers_orders(const Objective& objective);

/// Step `k`, from 0, as an assembly operation. It refers to `assembly`.
DISMANTLE_API Operation operation_of(const Disassembly& disassembly, std::size_t k, const Assembly& assembly,
                                     const Eigen::Vector3d& up);

/// Sets the objective of the plan of this disassembly, and the checks of its steps. A check that throws, or that says
/// what cannot be written, has `failed`, which is logged as an error. With an empty objective the plan stays as it is.
DISMANTLE_API void judge(Plan& plan, const Disassembly& disassembly, const Assembly& assembly,
                         const Objective& objective, const RunContext& context);

/// Creates the check of a type. @throws std::exception: it is not available here, and why.
using CheckOfType =
    std::function<std::shared_ptr<const StepCheck>(const std::string& type, const ParamSet& parameters)>;

/// Judges the steps of a plan again that check_plan() has found valid, and adds what it finds to `check`: the plan is
/// not valid when a verdict or a sum differs from what it says.
DISMANTLE_API void judge_again(PlanCheck& check, const Plan& plan, const Assembly& assembly,
                               const CheckOfType& check_of_type, const RunContext& context);

}  // namespace dismantle
