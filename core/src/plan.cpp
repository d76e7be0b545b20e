#include "dismantle/plan.h"

#include <map>

#include "dismantle/constraints.h"

namespace dismantle {

bool is_done(const PlanAsked& asked, const std::vector<std::vector<std::string>>& groups) {
  std::map<std::string, PartId> ids;
  const auto ids_of = [&](const std::vector<std::string>& names) {
    std::vector<PartId> out;
    for (const std::string& name : names) out.push_back(ids.emplace(name, static_cast<PartId>(ids.size())).first->second);
    return out;
  };
  Constraints constraints;
  for (const auto& list : asked.together) constraints.together.push_back(ids_of(list));
  const std::string& out = asked.part.empty() ? asked.target : asked.part;
  bool all = true;
  for (const auto& group : groups) {
    const bool done = kept_together(ids_of(group), constraints);
    if (done && !out.empty() && std::find(group.begin(), group.end(), out) != group.end()) return true;
    all = all && done;
  }
  return all;
}

bool Plan::succeeded() const {
  return status == PlanStatus::complete &&
         (!asked.part.empty() || std::none_of(assembly.excluded.begin(), assembly.excluded.end(),
                                              [](const PlanExcluded& part) { return part.unusable; }));
}

}  // namespace dismantle
