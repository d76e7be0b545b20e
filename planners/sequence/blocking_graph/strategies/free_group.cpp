#include "blocking_graph/strategies/free_group.h"

#include <algorithm>

namespace dismantle::blocking {

Result FreeGroup::apply(GroupState& group) {
  if (done_[group]) return Result::unchanged;
  unsigned proposed = 0;
  for (const Candidate& c : candidates(group)) {
    if (state_.stop() || proposed == proposals_) break;
    if (straight_.was_refused(c.ids, c.direction)) continue;
    ++proposed;
    if (straight_.leave(group, c.ids, c.direction)) return Result::restart;
  }
  done_[group] = true;
  return Result::unchanged;
}

/// Fewest parts first, then those that the objective likes best. Moving a group along d is equivalent to moving the
/// rest along -d, so the smaller one moves.
std::vector<FreeGroup::Candidate> FreeGroup::candidates(const GroupState& group) {
  std::vector<Candidate> found;
  const auto candidate = [&](Subassemblies ids, std::size_t direction) {
    const std::size_t parts = state_.parts_of(ids).size();
    return Candidate{std::move(ids), parts, direction};
  };
  for (const std::size_t d : straight_.directions().common) {
    if (state_.stop()) return {};
    for (Subassemblies& ids : straight_.free_groups(group, d)) {
      const Candidate rest = candidate(state_.others(group, ids), Directions::opposite(d));
      const Candidate own = candidate(std::move(ids), d);
      const bool own_first = own.parts <= rest.parts;
      for (const Candidate& c : {own_first ? own : rest, own_first ? rest : own})
        if (straight_.admits(filter_, c.direction) && state_.may_leave(group, c.ids)) {
          found.push_back(c);
          break;
        }
    }
  }
  if (const Preference& preference = state_.preference(); preference.active()) {
    std::vector<CandidateRemoval> removals;
    for (const Candidate& c : found)
      removals.push_back(state_.candidate(group, c.ids, straight_.directions().all[c.direction]));
    std::vector<Candidate> sorted;
    for (const std::size_t k : preference.sorted(removals, state_.context())) sorted.push_back(std::move(found[k]));
    found = std::move(sorted);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.parts < b.parts; });
  return found;
}

/// After partial translations groups are not examined again: that search ends when a group is free, and names it.
void FreeGroup::on_group_changed(GroupState& group, const GroupChange& change) {
  if (change.kind != GroupChange::Kind::translated) done_[group] = false;
}

}  // namespace dismantle::blocking
