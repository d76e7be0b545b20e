/// What the page shows of a plan beside the plan's own page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace dismantle::serve {

/// {"steps": [{"step", "parts", "forced"}, ...], "parts": [names]}: steps in the order and numbers of the assembly;
/// parts that the plan left out are named, too. @throws Error when the text is no plan.
nlohmann::json plan_view(const std::string& plan_json);

}  // namespace dismantle::serve
