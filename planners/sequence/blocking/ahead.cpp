// What will probably be asked next, for threads that have nothing else to do. Nothing that is said depends on it.
#include <algorithm>

#include "blocking/taking_apart.h"

namespace dismantle::blocking {
namespace {

constexpr unsigned kDepthForProofAhead = 2;  // of a search that was in vain

}  // namespace

/// Puts before idle threads: the search that is asked for now, what other groups wait for, which does not depend on its
/// outcome, and what follows here, either way; if the part is likely to stay, that first.
void TakingApart::prefetch(const Group& group, const Attempt& now, const std::vector<UnitId>& next) const {
  std::vector<Attempt> ahead{now};
  const std::vector<Attempt> if_out = next_if_out(group, now), if_not = next_if_not(group, now, next);
  if (likely_to_leave(group, now)) {
    add_others(ahead);
    for (std::size_t k = 0; k < std::max(if_out.size(), if_not.size()); ++k)
      for (const auto* list : {&if_out, &if_not})
        if (k < list->size()) ahead.push_back((*list)[k]);
  } else {
    ahead.insert(ahead.end(), if_not.begin(), if_not.end());
    add_others(ahead);
    ahead.insert(ahead.end(), if_out.begin(), if_out.end());
  }
  const std::size_t most = 1 + kAheadPerThread * context_.threads;
  if (ahead.size() > most) ahead.resize(most);
  // Proofs come first: whether they are needed may change, but not what they say.
  if (proofs_ahead_) proofs_ahead_->begin(likely_proofs(group), context_);
  oracle_.prefetch(ahead, context_);
}

/// The part that was searched is out: what was hinted for the case that it stays is of no more use.
void TakingApart::drop_hints_if_in(const Group& group, const Attempt& now) const {
  std::vector<Attempt> ahead = next_if_out(group, now);
  add_others(ahead);
  oracle_.prefetch(ahead, context_);
}

/// Little is found to depth 1, or where as much was searched before.
bool TakingApart::likely_to_leave(const Group& group, const Attempt& now) const {
  if (group.units.size() < 3 || now.max_depth < 2) return false;
  const auto known = tried_.find(now.moving.front().part);
  return known == tried_.end() || known->second.depth < now.max_depth;
}

/// Those that follow in its round, and the next round's.
std::vector<Attempt> TakingApart::next_if_not(const Group& group, const Attempt& now,
                                              const std::vector<UnitId>& next) const {
  std::vector<Attempt> ahead;
  add_searches(group, now.max_depth, next, ahead);
  if (group.searched_out) return ahead;
  if (group.units.size() == 2) {
    add_waiting(group, next_depth_of_pair(group, other_pairs_wait()), group.units, ahead);
  } else if (now.max_depth == group.depth && group.depth < deepest(group)) {
    add_next_round(group, ahead);
  }
  return ahead;
}

/// What is left to search of its round, without the part that is searched now, and the next round's.
std::vector<Attempt> TakingApart::next_if_out(const Group& group, const Attempt& now) const {
  std::vector<Attempt> ahead;
  if (group.units.size() < 3 || group.searched_out || now.max_depth != group.depth) return ahead;
  Group left = group;
  std::erase(left.units, unit_of_[now.moving.front().part]);
  add_round(left, ahead);
  if (left.depth < deepest(left)) add_next_round(left, ahead);
  return ahead;
}

/// What is searched next as things are.
std::vector<Attempt> TakingApart::next_searches(const Group& group) const {
  std::vector<Attempt> ahead;
  if (!group.searched_out)
    add_round(group, ahead);
  else if (group.units.size() == 2 && !group.pair_done)
    add_waiting(group, next_depth_of_pair(group, other_pairs_wait()), group.waiting, ahead);
  add_others(ahead);
  if (ahead.size() > kAheadPerThread * context_.threads) ahead.resize(kAheadPerThread * context_.threads);
  return ahead;
}

/// Those of a round that are worth trying.
void TakingApart::add_round(const Group& group, std::vector<Attempt>& ahead) const {
  std::vector<UnitId> list;
  for (const UnitId u : group.units)
    if (units_[u].size() == 1 && may_leave(group, {u}) && worth_trying(group, u, group.depth)) list.push_back(u);
  cheap_first(list, group.depth);
  add_searches(group, group.depth, list, ahead);
}

bool TakingApart::other_pairs_wait() const {
  return std::any_of(groups_.begin(), groups_.end(),
                     [](const Group& g) { return g.units.size() == 2 && !g.pair_done; });
}

void TakingApart::add_next_round(const Group& group, std::vector<Attempt>& ahead) const {
  std::vector<UnitId> again;
  for (const UnitId u : group.units)
    if (wants_depth(u) && tried_.at(units_[u].front()).depth == group.depth) again.push_back(u);
  cheap_first(again, group.depth + 1);
  add_waiting(group, group.depth + 1, again, ahead);
}

/// No more than idle threads may come to.
void TakingApart::add_searches(const Group& group, unsigned depth, const std::vector<UnitId>& units,
                               std::vector<Attempt>& ahead) const {
  for (std::size_t k = 0; k < std::min(units.size(), kAheadPerThread * context_.threads); ++k) {
    ahead.push_back(search_question(group, units[k], depth));
  }
}

/// What is proved of a pair; meanwhile idle threads seek what may be asked next.
const Certificate* TakingApart::proved(const Group& group, const HoldQuestion& question,
                                       std::span<const HoldQuestion> next) {
  std::vector<HoldQuestion> ahead(next.begin(), next.end());
  if (context_.threads > 1) {
    const std::vector<HoldQuestion> likely = likely_proofs(group);
    ahead.insert(ahead.end(), likely.begin(), likely.end());
    // What takes seconds, and mostly proves nothing. Others are over before a search is.
    if (question.kind != HoldQuestion::Kind::cage) oracle_.prefetch(next_searches(group), context_);
  }
  return proofs_ahead_->answer(question, ahead, context_);
}

/// The next searches of the groups that wait.
void TakingApart::add_others(std::vector<Attempt>& ahead) const {
  for (const Group& g : groups_)
    if (g.units.size() == 2 && g.searched_out && !g.pair_done)
      add_waiting(g, next_depth_of_pair(g, true), g.waiting, ahead);
    else if (g.units.size() > 1 && !g.searched_out)
      add_waiting(g, g.depth, g.waiting, ahead);
}

void TakingApart::add_waiting(const Group& group, unsigned depth, const std::vector<UnitId>& units,
                              std::vector<Attempt>& ahead) const {
  for (const UnitId u : units) {
    if (!in_group(group, u) || !wants_depth(u) || !may_leave(group, {u})) continue;
    ahead.push_back(search_question(group, u, depth));
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

/// Puts before idle threads what will be asked where no slide is found.
void TakingApart::seek_cages(const Group& group) const {
  if (!relations_ || !params_.cages) return;
  const auto passes = [&](PartId a, PartId b) {
    return std::any_of(directions_.of_part[a].begin(), directions_.of_part[a].end(), [&](std::size_t d) {
      const Pair pair{a, b, d, poses_[a].t - poses_[b].t, turn_[a], turn_[b]};
      return relations_->known(pair) && !relations_->blocks(pair);
    });
  };
  std::vector<HoldQuestion> questions = cage_questions(group);
  std::erase_if(questions,
                [&](const HoldQuestion& q) { return asked_.contains(q) || passes(q.a, q.b) || passes(q.b, q.a); });
  proofs_ahead_->begin(questions, context_);
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
