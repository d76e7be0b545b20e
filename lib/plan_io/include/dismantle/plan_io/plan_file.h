/// plan.json: writing and reading (docs/plan-format.md).
#pragma once

#include <string>
#include <string_view>

#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// Name in files and messages.
DISMANTLE_API std::string_view to_string(PlanStatus status);
/// Name in files and messages.
DISMANTLE_API std::string_view to_string(AssemblyStatus status);
/// Same plan, same bytes. Times are the only fields that vary between runs.
DISMANTLE_API std::string to_json(const Plan& plan);
/// @throws InputError naming `source` and the location of the problem.
DISMANTLE_API Plan plan_from_json(const std::string& text, const std::string& source);
/// Can the text stand in a plan as the data of a note: is it one valid JSON object without duplicate keys?
DISMANTLE_API bool is_json_object(const std::string& text);

}  // namespace dismantle
