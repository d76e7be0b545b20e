// What will probably be asked next, for threads that have nothing else to do. Nothing that is said depends on it.
#include <algorithm>

#include "blocking/taking_apart.h"

namespace dismantle::blocking {
namespace {

constexpr unsigned kDepthForProofAhead = 2;  // of a search that was in vain

}  // namespace

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
  // Proofs come first: whether they are needed may change, but not what they say.
  std::size_t threads = context_.threads;
  if (confinements_ahead_) {
    confinements_ahead_->begin(likely_to_be_confined(group), threads - 1, context_);
    threads -= std::min(threads - 1, confinements_ahead_->working());
  }
  const std::size_t left = threads > 1 ? 1 + kAheadPerThread * threads : 1;
  if (ahead.size() > left) ahead.resize(left);
  oracle_.prefetch(ahead, context_);
}

/// What the judge says of a pair; meanwhile other pairs have the other threads.
std::optional<Confinement> TakingApart::confined(const Group& group, PartId a, PartId b, double share) {
  if (context_.threads < 2) return oracle_.judge()->confined(a, b, context_, share);
  oracle_.prefetch({}, context_);
  return confinements_ahead_->answer({std::min(a, b), std::max(a, b), share}, likely_to_be_confined(group), context_);
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

/// What may be asked about pairs, the likeliest first: of groups that wait for just that; of parts that were searched
/// for some depth and have one other in their way; of other groups of two.
std::vector<ConfinementsAhead::Question> TakingApart::likely_to_be_confined(const Group& now) const {
  std::vector<ConfinementsAhead::Question> all;
  if (!relations_ || !params_.cages) return all;
  std::vector<const Group*> groups{&now};
  for (const Group& g : groups_) groups.push_back(&g);
  const auto add = [&](UnitId u, UnitId v, double share, const std::set<std::pair<PartId, PartId>>& asked) {
    for (const PartId a : units_[u])
      for (const PartId b : units_[v])
        if (!asked.contains(std::minmax(a, b))) all.push_back({std::min(a, b), std::max(a, b), share});
  };
  const auto pairs_that = [&](bool searched) {
    for (const Group* g : groups) {
      if (g->units.size() != 2 || g->searches_done != searched) continue;
      const UnitId u = g->units[0], v = g->units[1];
      if (searched || wants_depth(u) || wants_depth(v)) add(u, v, kShareAtLast, confined_);
    }
  };
  pairs_that(true);
  for (const Group* g : groups)
    for (const UnitId u : g->units) {
      if (g->units.size() == 2 || !wants_depth(u) || tried_.at(units_[u].front()).depth < kDepthForProofAhead) continue;
      if (const std::optional<UnitId> v = alone_in_the_way(*g, u)) add(u, *v, kShareForSure, sure_);
    }
  pairs_that(false);
  return all;
}

}  // namespace dismantle::blocking
