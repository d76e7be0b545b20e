/// What became of the steps of an earlier plan, for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "dismantle/session/revision.h"

namespace dismantle::app {

/// One line, and one for each step that was not kept. `plan`: file name of the earlier plan.
std::string kept_text(const KeptSteps& kept, const std::string& plan);
/// Array of `{"step", "parts", "kept", "reason"}`, with the numbers of the earlier plan's disassembly.
nlohmann::ordered_json revised_json(const KeptSteps& kept);

}  // namespace dismantle::app
