#include "blocking/strategies/target_first.h"

#include <algorithm>

namespace dismantle::blocking {

/// If a wanted subassembly is not free, its blockers along the direction with the fewest are wanted too.
Result TargetFirst::apply(GroupState& group) {
  if (!state_.constraints().target) return Result::unchanged;
  const SubassemblyId target = state_.subassembly_of(*state_.constraints().target);
  if (!group.contains(target)) return Result::unchanged;
  Subassemblies wanted{target};
  for (std::size_t k = 0; k < wanted.size() && !state_.stop(); ++k) {
    const SubassemblyId id = wanted[k];
    if (state_.may_leave(group, {id}))
      while (const auto d = straight_.free_direction(group, id))
        if (straight_.leave(group, {id}, *d)) return Result::restart;
    for (const SubassemblyId other : straight_.fewest_blockers(group, id, straight_.directions_of(group, id)))
      if (std::find(wanted.begin(), wanted.end(), other) == wanted.end()) wanted.push_back(other);
  }
  return Result::unchanged;
}

}  // namespace dismantle::blocking
