/// The configuration of the run that made a plan.
#pragma once

#include <filesystem>

#include "dismantle/plan_io/explain.h"

namespace dismantle::app {

/// The values in resolved.yaml beside the plan, so that advice can quote them; none if there is no such file.
ExplainSettings settings_beside(const std::filesystem::path& plan);

}  // namespace dismantle::app
