/// Plans in words. UTF-8.
#pragma once

#include <cstddef>
#include <string>

#include "dismantle/export.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"

namespace dismantle {

/// Is what was asked for done? "complete" (Plan::succeeded()), "forced" or "partial".
DISMANTLE_API std::string result_word(const Plan& plan);
/// The same with what was asked for: "complete: cover is out, which was the target". No line break.
DISMANTLE_API std::string result_text(const Plan& plan);
/// Forced steps that the user accepts (constraints.accept).
DISMANTLE_API std::size_t accepted_steps(const Plan& plan);
/// For a terminal, with a line break at the end: what came out in which order, what stays, what was left out, what
/// could not be solved. `details`: with the time of the search and the penetration of every step.
/// `unit`: of all lengths; empty name: length_unit().
DISMANTLE_API std::string summary_text(const Plan& plan, bool details = false, TextUnit unit = {});

}  // namespace dismantle
