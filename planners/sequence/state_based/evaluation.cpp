#include "state_based/evaluation.h"

#include <algorithm>
#include <map>

namespace dismantle::state_based {

Subassemblies by_evaluation(const blocking::DisassemblyState& state, const MotionStates& states,
                            const GroupState& group, Subassemblies ids, StateBasedEvaluation evaluation) {
  std::map<SubassemblyId, double> use;
  std::map<SubassemblyId, std::size_t> blockers;
  const SubassemblyId housing = state.housing_of(group);
  for (const SubassemblyId s : group.members) {
    const auto fewest = states.fewest_blockers(group, s, housing);
    blockers[s] = fewest ? fewest->size() : group.members.size();  // held by the housing everywhere: last
    if (!fewest) continue;
    for (const SubassemblyId other : *fewest) use[other] += 1.0 / static_cast<double>(fewest->size());
  }
  std::stable_sort(ids.begin(), ids.end(), [&](SubassemblyId a, SubassemblyId b) {
    if ((a == housing) != (b == housing)) return b == housing;
    if (evaluation == StateBasedEvaluation::most_useful && use[a] != use[b]) return use[a] > use[b];
    if (blockers[a] != blockers[b]) return blockers[a] < blockers[b];
    return use[a] > use[b];
  });
  return ids;
}

}  // namespace dismantle::state_based
