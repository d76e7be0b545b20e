/// Judges the steps of a disassembly as assembly operations, by the checks of an objective.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/disassembly.h"
#include "dismantle/export.h"
#include "dismantle/param_value.h"
#include "dismantle/plan.h"
#include "dismantle/run_context.h"
#include "dismantle/step_check.h"

namespace dismantle {

/// Step `k`, from 0, as an assembly operation. It refers to `assembly`.
DISMANTLE_API Operation operation_of(const Disassembly& disassembly, std::size_t k, const Assembly& assembly,
                                     const Eigen::Vector3d& up);
/// All steps as assembly operations, in the order of assembly: the last step first.
DISMANTLE_API std::deque<Operation> operations_of(const Disassembly& disassembly, const Assembly& assembly,
                                                  const Eigen::Vector3d& up);

/// Sets the objective of the plan of this disassembly, and the checks of its steps. A check that throws, or that says
/// what cannot be written, has `failed`, which is logged as an error. With an empty objective the plan stays as it is.
DISMANTLE_API void judge(Plan& plan, const Disassembly& disassembly, const Assembly& assembly,
                         const Objective& objective, const RunContext& context);

/// Creates the check of a type. @throws std::exception: it is not available here, and why.
using CheckOfType =
    std::function<std::shared_ptr<const StepCheck>(const std::string& type, const ParamSet& parameters)>;

/// How the verdicts of a plan compare to those of the same checks now.
struct JudgementCheck {
  std::size_t verdicts = 0;              ///< judged again
  std::vector<std::string> problems;     ///< verdicts or sums that differ
  std::vector<std::string> not_checked;  ///< "'acme.x': ...": a check that is not available here, and why
};

/// Judges the steps of a plan again. `disassembly`: of the plan (disassembly_of()).
DISMANTLE_API JudgementCheck judge_again(const Plan& plan, const Disassembly& disassembly, const Assembly& assembly,
                                         const CheckOfType& check_of_type, const RunContext& context);

}  // namespace dismantle
