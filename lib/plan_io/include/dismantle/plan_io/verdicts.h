/// What the checks of an objective say of a step, for people.
#pragma once

#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// Of an assembly step: what the plan says of the disassembly step that it reverses.
DISMANTLE_API const std::vector<PlanVerdict>& checks_of_assembly_step(const Plan& plan, const PlanStep& step);

/// One line for each cost, refusal and failure ("directions: cost 1: the direction ..."), without the notes.
DISMANTLE_API std::vector<std::string> cost_lines(const std::vector<PlanVerdict>& checks);

/// "objective: 3.5 in all; directions: 3, weight 1; ..."; empty: the plan was not judged.
DISMANTLE_API std::string objective_text(const Plan& plan);

}  // namespace dismantle
