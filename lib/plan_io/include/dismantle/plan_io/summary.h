/// Plans in words, for a terminal. UTF-8, each text ends with a line break.
#pragma once

#include <string>

#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// What came out in which order, what stays, what was left out, what could not be solved.
DISMANTLE_API std::string summary_text(const Plan& plan);

}  // namespace dismantle
