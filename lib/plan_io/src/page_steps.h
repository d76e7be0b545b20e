/// What the page shows of each step besides its motion.
#pragma once

#include <nlohmann/json.hpp>

#include "dismantle/plan.h"

namespace dismantle {

/// `view.steps` of a page (docs/viewer.md): how the assembly lies.
nlohmann::ordered_json page_steps(const Plan& plan);

}  // namespace dismantle
