#include "report/observations.h"

#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "dismantle/errors.h"
#include "report/stored_plans.h"

namespace dismantle::bench {
namespace {

/// The steps of a plan, without the times of their search.
std::string steps_of(const ReportRow& row, StoredPlans& plans) {
  if (!row.has_plan) return {};
  try {
    nlohmann::json steps = nlohmann::json::parse(plans.of(row)).at("disassembly");
    for (auto& step : steps) step.erase("seconds");
    return steps.dump();
  } catch (const nlohmann::json::exception& e) {
    throw InputError(row.database.string(), "the plan of row " + std::to_string(row.id) + ": " + e.what());
  }
}

}  // namespace

void number_observations(std::vector<ReportRow>& rows) {
  const auto key = [](const ReportRow& r) {
    const ReportRow unsolved;  // what came of a trial that is not solved does not distinguish it
    const ReportRow& result = r.solved ? r : unsolved;
    return std::make_tuple(r.planner, r.variant, r.assembly, r.input_sha256, r.solved, result.steps, result.removed,
                           result.max_penetration);
  };
  std::map<decltype(key(ReportRow{})), std::vector<ReportRow*>> alike;
  for (ReportRow& row : rows) alike[key(row)].push_back(&row);
  StoredPlans plans;
  std::size_t number = 0;
  for (const auto& [what, group] : alike) {
    std::map<std::string, std::size_t> numbers;
    for (ReportRow* row : group) {
      const bool compare = group.size() > 1 && row->solved;
      const auto [known, is_new] = numbers.try_emplace(compare ? steps_of(*row, plans) : "", number + 1);
      if (is_new) ++number;
      row->observation = known->second;
    }
  }
}

}  // namespace dismantle::bench
