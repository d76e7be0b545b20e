/// Plans, checks and preparations in words, for a terminal. UTF-8, each ends with a line break.
#pragma once

#include <string>

#include "dismantle/export.h"
#include "dismantle/assembly.h"
#include "dismantle/verification/check_plan.h"
#include "dismantle/plan.h"
#include "dismantle/preparation/prepare.h"

namespace dismantle {

/// What came out in which order, what stays, what was left out, what could not be solved.
DISMANTLE_API std::string summary_text(const Plan& plan);

/// Why each unsolved part is still there: how its attempt ended, what it touched, how far it came.
DISMANTLE_API std::string explain_text(const Plan& plan);

/// The verdict, step by step.
DISMANTLE_API std::string check_text(const Plan& plan, const PlanCheck& check);

/// What was done to each part and why.
DISMANTLE_API std::string prepare_text(const Assembly& assembly, const PrepareReport& report);

}  // namespace dismantle
