#include "dismantle/engine/broken_constraint.h"

#include <algorithm>
#include <vector>

#include "dismantle/part_set.h"

namespace dismantle {

std::string broken_constraint(const DisassemblyStep& step, std::span<const PartId> group,
                              const Constraints& constraints) {
  for (const PartId id : constraints.base)
    if (contains(step.parts, id)) return "it moves a part of the base";
  for (const auto& list : constraints.together) {
    const auto moves = [&](PartId id) { return contains(step.parts, id); };
    const bool any = std::any_of(list.begin(), list.end(), moves);
    if (any && (!std::all_of(list.begin(), list.end(), moves) || (step.released && list.size() > 1)))
      return "it takes apart what is to stay together";
  }
  if (step.placement) return {};
  const std::vector<PartId> leaving = step.released ? std::vector<PartId>{*step.released} : step.parts;
  return may_leave(leaving, without(group, leaving), constraints) ? "" : "another part has to leave first";
}

}  // namespace dismantle
