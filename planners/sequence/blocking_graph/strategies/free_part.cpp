#include "blocking_graph/strategies/free_part.h"

#include <span>
#include <utility>
#include <vector>

namespace dismantle::blocking {

Result FreePart::apply(GroupState& group) {
  if (state_.preference().active()) return apply_preferred(group);
  const Subassemblies ids = group.members;
  for (std::size_t k = 0; k < ids.size() && !state_.stop(); ++k) {
    if (!state_.may_leave(group, {ids[k]})) continue;
    while (const auto d = straight_.free_direction(group, ids[k], std::span(ids).subspan(k + 1), filter_))
      if (straight_.leave(group, {ids[k]}, *d)) return Result::restart;
  }
  return Result::unchanged;
}

/// Proposes all free parts along all their free directions, the one that the objective likes best first.
Result FreePart::apply_preferred(GroupState& group) {
  std::vector<std::pair<SubassemblyId, std::size_t>> free;
  std::vector<CandidateRemoval> candidates;
  for (const SubassemblyId id : group.members) {
    if (!state_.may_leave(group, {id})) continue;
    for (const std::size_t d : straight_.free_directions(group, id)) {
      if (!straight_.admits(filter_, d)) continue;
      free.emplace_back(id, d);
      candidates.push_back(state_.candidate(group, {id}, straight_.directions().all[d]));
    }
  }
  for (const std::size_t k : state_.preference().sorted(candidates, state_.context())) {
    if (state_.stop()) break;
    if (straight_.leave(group, {free[k].first}, free[k].second)) return Result::restart;
  }
  return Result::unchanged;
}

}  // namespace dismantle::blocking
