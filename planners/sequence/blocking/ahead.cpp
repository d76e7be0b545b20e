// What will probably be asked next, for threads that have nothing else to do. Nothing that is said depends on it.
#include <algorithm>

#include "blocking/taking_apart.h"

namespace dismantle::blocking {

/// Hints the search that is asked for now, those that follow it in its round, those of the groups that wait, and the
/// next round's.
void TakingApart::prefetch(const Group& group, const Attempt& now, const std::vector<UnitId>& next) const {
  std::vector<Attempt> ahead{now};
  const std::size_t most = 1 + kAheadPerThread * context_.threads;
  for (std::size_t k = 0; k < next.size() && ahead.size() < most; ++k) {
    ahead.push_back(question(group, {next[k]}));
    ahead.back().max_depth = now.max_depth;
  }
  if (group.units.size() == 2 && !group.searched_out) add_waiting(group, 2 * group.pair_depth, group.units, ahead);
  add_others(ahead);
  if (group.units.size() > 2 && !group.searched_out && now.max_depth == group.depth && group.depth < deepest(group)) {
    std::vector<UnitId> again;
    for (const UnitId u : group.units)
      if (wants_depth(u) && tried_.at(units_[u].front()).depth == group.depth) again.push_back(u);
    cheap_first(again, group.depth + 1);
    add_waiting(group, group.depth + 1, again, ahead);
  }
  if (ahead.size() > most) ahead.resize(most);
  oracle_.prefetch(ahead, context_);
  if (ahead.size() == 1 && confinements_ahead_)
    confinements_ahead_->begin(pairs_to_confine(), context_.threads - 1, context_);
}

/// What the judge says of a pair; meanwhile other pairs have the other threads.
std::optional<Confinement> TakingApart::confined(PartId a, PartId b) {
  if (context_.threads > 1) oracle_.prefetch({}, context_);
  return confinements_ahead_->answer(std::minmax(a, b), pairs_to_confine(), context_);
}

/// The next searches of the groups that wait.
void TakingApart::add_others(std::vector<Attempt>& ahead) const {
  for (const Group& g : groups_)
    if (g.units.size() == 2 && g.searched_out && !g.pair_done)
      add_waiting(g, g.pair_depth >= kDeepestPair ? 0 : 2 * g.pair_depth, g.waiting, ahead);
    else if (g.units.size() > 1 && !g.searched_out)
      add_waiting(g, g.depth, g.waiting, ahead);
}

void TakingApart::add_waiting(const Group& group, unsigned depth, const std::vector<UnitId>& units,
                              std::vector<Attempt>& ahead) const {
  for (const UnitId u : units) {
    if (!in_group(group, u) || !wants_depth(u) || !may_leave(group, {u})) continue;
    ahead.push_back(question(group, {u}));
    ahead.back().max_depth = depth;
  }
}

/// Of the groups that wait for that.
std::vector<std::pair<PartId, PartId>> TakingApart::pairs_to_confine() const {
  std::vector<std::pair<PartId, PartId>> pairs;
  for (const Group& g : groups_) {
    if (!g.searches_done || g.units.size() != 2) continue;
    for (const PartId a : units_[g.units[0]])
      for (const PartId b : units_[g.units[1]])
        if (const std::pair<PartId, PartId> pair = std::minmax(a, b); !confined_.contains(pair)) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace dismantle::blocking
