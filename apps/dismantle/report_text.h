/// The output of `verify` and `prepare`. UTF-8; each text ends with a line break.
#pragma once

#include <string>

#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {

/// The result of a check, step by step.
std::string check_text(const Plan& plan, const PlanCheck& check);

/// The changes to each part, with reasons.
std::string prepare_text(const Assembly& assembly, const PrepareReport& report, bool verbose = false);

}  // namespace dismantle
