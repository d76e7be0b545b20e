#include "plan_view.h"

#include <fmt/format.h>

#include "dismantle/errors.h"

namespace dismantle::serve {

nlohmann::json plan_view(const std::string& plan_json) {
  try {
    const auto plan = nlohmann::json::parse(plan_json);
    const auto& assembly = plan.at("assembly");
    const auto& disassembly = plan.at("disassembly");
    nlohmann::json parts = nlohmann::json::array(), steps = nlohmann::json::array();
    for (const auto& part : assembly.at("parts")) parts.push_back(part.at("name"));
    if (assembly.contains("excluded"))
      for (const auto& part : assembly["excluded"]) parts.push_back(part.at("name"));
    for (std::size_t k = disassembly.size(); k-- > 0;) {
      nlohmann::json moved = nlohmann::json::array();
      for (const auto& move : disassembly[k].at("moves")) moved.push_back(move.at("part"));
      steps.push_back(
          {{"step", disassembly.size() - k}, {"parts", moved}, {"forced", disassembly[k].contains("forced")}});
      if (steps.back()["forced"].get<bool>() && disassembly[k]["forced"].contains("pair")) {
        const auto& forced = disassembly[k]["forced"];
        steps.back()["cut"] = {{"part", forced.at("pair").at(0)},
                               {"against", forced.at("pair").at(1)},
                               {"depth", forced.at("depth")},
                               {"accepted", forced.value("accepted", "")}};
      }
    }
    return {{"steps", steps}, {"parts", parts}};
  } catch (const nlohmann::json::exception& e) {
    throw Error(fmt::format("plan.json cannot be read: {}", e.what()));
  }
}

}  // namespace dismantle::serve
