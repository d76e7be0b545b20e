#include "blocking_graph/stated_groups.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace dismantle::blocking {

StatedGroups::StatedGroups(const Assembly& assembly) {
  std::map<std::string, std::set<PartId>> parts;
  for (const ReferenceStep& step : assembly.reference_order)
    parts[step.group].insert(step.parts.begin(), step.parts.end());
  for (const auto& [name, list] : parts)
    if (list.size() > 1) groups_.emplace_back(list.begin(), list.end());
  std::stable_sort(groups_.begin(), groups_.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
}

std::vector<Subassemblies> StatedGroups::items(const DisassemblyState& state, const GroupState& group) const {
  std::vector<Subassemblies> items;
  std::set<SubassemblyId> left(group.members.begin(), group.members.end());
  for (const std::vector<PartId>& stated : groups_) {
    Subassemblies inside;
    for (const SubassemblyId id : left) {
      const std::vector<PartId>& parts = state.parts_of(id);
      if (std::includes(stated.begin(), stated.end(), parts.begin(), parts.end())) inside.push_back(id);
    }
    if (inside.size() < 2 || inside.size() == group.members.size()) continue;
    for (const SubassemblyId id : inside) left.erase(id);
    items.push_back(std::move(inside));
  }
  for (const SubassemblyId id : group.members)
    if (left.contains(id)) items.push_back({id});
  return items;
}

}  // namespace dismantle::blocking
