/// Verdicts of step checks as JSON, the same in all files.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "dismantle/plan.h"

namespace dismantle {

/// As under a step of plan.json; for json_text().
nlohmann::ordered_json verdicts_json(const std::vector<PlanVerdict>& checks);

}  // namespace dismantle
