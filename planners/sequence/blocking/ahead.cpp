// What will probably be asked next, for threads that have nothing else to do. Nothing that is said depends on it.
#include <algorithm>

#include "blocking/taking_apart.h"

namespace dismantle::blocking {
namespace {

constexpr unsigned kDepthForProofAhead = 2;  // of a search that was in vain

}  // namespace

/// Hints the search that is asked for now, and what comes after it, the likeliest first: what follows if the part
/// leaves, or if not, and what other groups wait for, which does not depend on that.
void TakingApart::prefetch(const Group& group, const Attempt& now, const std::vector<UnitId>& next) const {
  std::vector<Attempt> ahead{now};
  const bool leaves = likely_to_leave(group, now);
  if (!leaves) add_next(group, now, next, ahead);
  add_others(ahead);
  add_after(group, now, ahead);
  if (leaves) add_next(group, now, next, ahead);
  const std::size_t most = 1 + kAheadPerThread * context_.threads;
  if (ahead.size() > most) ahead.resize(most);
  // Proofs come first: whether they are needed may change, but not what they say.
  if (proofs_ahead_) proofs_ahead_->begin(likely_proofs(group), context_);
  oracle_.prefetch(ahead, context_);
}

/// Little is found to depth 1, or where as much was searched before.
bool TakingApart::likely_to_leave(const Group& group, const Attempt& now) const {
  if (group.units.size() < 3 || now.max_depth < 2) return false;
  const auto known = tried_.find(now.moving.front().part);
  return known == tried_.end() || known->second.depth < now.max_depth;
}

/// Those that follow in its round, and the next round's.
void TakingApart::add_next(const Group& group, const Attempt& now, const std::vector<UnitId>& next,
                           std::vector<Attempt>& ahead) const {
  const std::size_t most = ahead.size() + kAheadPerThread * context_.threads;
  for (std::size_t k = 0; k < next.size() && ahead.size() < most; ++k) {
    ahead.push_back(question(group, {next[k]}));
    ahead.back().max_depth = now.max_depth;
  }
  if (group.searched_out) return;
  if (group.units.size() == 2) {
    add_waiting(group, 2 * group.pair_depth, group.units, ahead);
  } else if (now.max_depth == group.depth && group.depth < deepest(group)) {
    std::vector<UnitId> again;
    for (const UnitId u : group.units)
      if (wants_depth(u) && tried_.at(units_[u].front()).depth == group.depth) again.push_back(u);
    cheap_first(again, group.depth + 1);
    add_waiting(group, group.depth + 1, again, ahead);
  }
}

/// The searches of its round, without the part that is searched now.
void TakingApart::add_after(const Group& group, const Attempt& now, std::vector<Attempt>& ahead) const {
  if (group.units.size() < 3 || group.searched_out || now.max_depth != group.depth) return;
  Group left = group;
  std::erase(left.units, unit_of_[now.moving.front().part]);
  std::vector<UnitId> list;
  for (const UnitId u : left.units)
    if (units_[u].size() == 1 && may_leave(left, {u}) && worth_trying(left, u, left.depth)) list.push_back(u);
  cheap_first(list, left.depth);
  const std::size_t most = ahead.size() + kAheadPerThread * context_.threads;
  for (std::size_t k = 0; k < list.size() && ahead.size() < most; ++k) {
    ahead.push_back(question(left, {list[k]}));
    ahead.back().max_depth = left.depth;
  }
}

/// What the judge says of a pair; meanwhile idle threads seek what may be asked next.
std::optional<std::string> TakingApart::proved(const Group& group, const HoldQuestion& question,
                                               std::span<const HoldQuestion> next) {
  std::vector<HoldQuestion> ahead(next.begin(), next.end());
  if (context_.threads > 1) {
    const std::vector<HoldQuestion> likely = likely_proofs(group);
    ahead.insert(ahead.end(), likely.begin(), likely.end());
  }
  return proofs_ahead_->answer(question, ahead, context_);
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

/// Do they, along all of their directions, as far as that was asked before? And it was.
bool TakingApart::known_to_block(PartId a, PartId b) const {
  const auto known = [&](std::size_t d) {
    const Pair pair{a, b, d, poses_[a].t - poses_[b].t, turn_[a], turn_[b]};
    return relations_->known(pair) && relations_->blocks(pair);
  };
  return std::all_of(directions_.of_part[a].begin(), directions_.of_part[a].end(), known) &&
         std::all_of(directions_.of_part[b].begin(), directions_.of_part[b].end(), known);
}

/// What may be asked about pairs, the likeliest first: about flat pieces of the group; of groups that wait for just
/// that; of parts that were searched for some depth and have one other in their way; of other groups of two.
std::vector<HoldQuestion> TakingApart::likely_proofs(const Group& now) const {
  using Kind = HoldQuestion::Kind;
  std::vector<HoldQuestion> all;
  if (!relations_ || !params_.cages) return all;
  for (const HoldQuestion& q : flat_questions(now))
    if (known_to_block(q.a, q.b)) all.push_back(q);
  std::vector<const Group*> groups{&now};
  for (const Group& g : groups_) groups.push_back(&g);
  const auto pairs_that = [&](bool searched) {
    for (const Group* g : groups) {
      if (g->units.size() != 2 || g->searches_done != searched) continue;
      const UnitId u = g->units[0], v = g->units[1];
      if (searched || wants_depth(u) || wants_depth(v)) add_questions(Kind::confined_at_last, u, v, all);
    }
  };
  pairs_that(true);
  for (const Group* g : groups)
    for (const UnitId u : g->units) {
      if (g->units.size() == 2 || !wants_depth(u) || tried_.at(units_[u].front()).depth < kDepthForProofAhead) continue;
      if (const std::optional<UnitId> v = alone_in_the_way(*g, u)) add_questions(Kind::confined_for_sure, u, *v, all);
    }
  pairs_that(false);
  std::erase_if(all, [&](const HoldQuestion& q) { return asked_.contains(q); });
  return all;
}

}  // namespace dismantle::blocking
