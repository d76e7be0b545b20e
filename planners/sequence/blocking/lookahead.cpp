#include "blocking/lookahead.h"

#include <algorithm>
#include <utility>

namespace dismantle::blocking {
Lookahead::Lookahead(const DisassemblyState& state, const SearchHistory& history, PathOracle& oracle)
    : state_(state), history_(history), oracle_(oracle) {}

bool Lookahead::is_active() const { return state_.context().threads > 1; }

/// Four attempts per thread keep all threads busy until the next hint; results do not depend on the number.
std::size_t Lookahead::most() const { return 4 * state_.context().threads; }

/// The next searches of other groups do not depend on the outcome of `now`, those of this group do. The searches after
/// the likelier outcome come first.
void Lookahead::before_search(const GroupState& group, const Attempt& now, const Subassemblies& next) const {
  if (!is_active()) return;
  Attempts ahead{now};
  const Attempts success = after_success_of(group, now), failure = after_failure_of(group, now, next);
  if (is_likely_to_leave(group, now)) {
    add_other_groups(ahead);
    for (std::size_t k = 0; k < std::max(success.size(), failure.size()); ++k)
      for (const auto* list : {&success, &failure})
        if (k < list->size()) ahead.push_back((*list)[k]);
  } else {
    ahead.insert(ahead.end(), failure.begin(), failure.end());
    add_other_groups(ahead);
    ahead.insert(ahead.end(), success.begin(), success.end());
  }
  if (ahead.size() > 1 + most()) ahead.resize(1 + most());
  oracle_.prefetch(ahead, state_.context());
}

void Lookahead::after_success(const GroupState& group, const Attempt& now) const {
  if (!is_active()) return;
  Attempts ahead = after_success_of(group, now);
  add_other_groups(ahead);
  oracle_.prefetch(ahead, state_.context());
}

void Lookahead::before_attempts(const Attempt& now, Attempts next) const {
  if (!is_active()) return;
  if (next.size() > most()) next.resize(most());
  next.insert(next.begin(), now);
  oracle_.prefetch(next, state_.context());
}

/// A search to depth 1, or no deeper than the last one for the part, rarely succeeds.
bool Lookahead::is_likely_to_leave(const GroupState& group, const Attempt& now) const {
  if (group.members.size() < 3 || now.max_depth < 2) return false;
  const PastSearch* search = history_.last(state_.subassembly_of(now.moving.front().part));
  return search == nullptr || search->depth < now.max_depth;
}

/// The searches that follow if `now` fails: in this round, and in the next one.
Lookahead::Attempts Lookahead::after_failure_of(const GroupState& group, const Attempt& now,
                                                const Subassemblies& next) const {
  Attempts ahead;
  add_searches(group, now.max_depth, next, ahead);
  if (group.searches_exhausted) return ahead;
  if (group.is_pair())
    add_waiting(group, history_.next_depth_of_pair(group, other_pairs_wait()), group.members, ahead);
  else if (now.max_depth == group.search_depth && group.search_depth < history_.max_depth(group))
    add_next_round(group, ahead);
  return ahead;
}

/// The searches that follow if `now` succeeds: in this round without the removed part, and in the next one.
Lookahead::Attempts Lookahead::after_success_of(const GroupState& group, const Attempt& now) const {
  Attempts ahead;
  if (group.members.size() < 3 || group.searches_exhausted || now.max_depth != group.search_depth) return ahead;
  GroupState left = group;
  std::erase(left.members, state_.subassembly_of(now.moving.front().part));
  add_round(left, ahead);
  if (left.search_depth < history_.max_depth(left)) add_next_round(left, ahead);
  return ahead;
}

void Lookahead::add_round(const GroupState& group, Attempts& attempts) const {
  Subassemblies list;
  for (const SubassemblyId s : group.members)
    if (state_.is_single(s) && state_.may_leave(group, {s}) && history_.is_worthwhile(group, s, group.search_depth))
      list.push_back(s);
  history_.sort_by_cost(group, list, group.search_depth);
  add_searches(group, group.search_depth, list, attempts);
}

bool Lookahead::other_pairs_wait() const {
  const auto& waiting = state_.waiting();
  return std::any_of(waiting.begin(), waiting.end(),
                     [](const GroupState& g) { return g.is_pair() && !g.pair_finished; });
}

void Lookahead::add_next_round(const GroupState& group, Attempts& attempts) const {
  Subassemblies again;
  for (const SubassemblyId s : group.members)
    if (history_.reached_depth_limit(s) && history_.last(s)->depth == group.search_depth) again.push_back(s);
  history_.sort_by_cost(group, again, group.search_depth + 1);
  add_waiting(group, group.search_depth + 1, again, attempts);
}

/// Adds at most most() attempts: idle threads get no further.
void Lookahead::add_searches(const GroupState& group, unsigned depth, const Subassemblies& ids,
                             Attempts& attempts) const {
  for (std::size_t k = 0; k < std::min(ids.size(), most()); ++k)
    attempts.push_back(history_.attempt_for(group, ids[k], depth));
}

/// Adds the next searches of the waiting groups.
void Lookahead::add_other_groups(Attempts& attempts) const {
  for (const GroupState& g : state_.waiting())
    if (g.is_pair() && g.searches_exhausted && !g.pair_finished)
      add_waiting(g, history_.next_depth_of_pair(g, true), g.waiting, attempts);
    else if (g.members.size() > 1 && !g.searches_exhausted)
      add_waiting(g, g.search_depth, g.waiting, attempts);
}

void Lookahead::add_waiting(const GroupState& group, unsigned depth, const Subassemblies& ids,
                            Attempts& attempts) const {
  for (const SubassemblyId s : ids) {
    if (!group.contains(s) || !history_.reached_depth_limit(s) || !state_.may_leave(group, {s})) continue;
    attempts.push_back(history_.attempt_for(group, s, depth));
  }
}

}  // namespace dismantle::blocking
