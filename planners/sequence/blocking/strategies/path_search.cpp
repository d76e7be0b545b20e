#include "blocking/strategies/path_search.h"

#include <algorithm>

namespace dismantle::blocking {

/// A group that needs a deeper round waits until the other groups have had their rounds.
Result PathSearch::apply(GroupState& group) {
  const auto& waiting = state_.waiting();
  const bool last_group =
      std::none_of(waiting.begin(), waiting.end(), [](const GroupState& g) { return g.members.size() > 1; });
  // The last pair is left to PairSearch.
  if (!params_.path_searches || (group.is_pair() && last_group)) group.searches_exhausted = true;
  if (group.searches_exhausted) return Result::unchanged;
  if (round(group)) return Result::restart;
  return group.searches_exhausted || waiting.empty() || state_.stop() ? Result::restart : Result::defer;
}

/// True: a part left.
bool PathSearch::round(GroupState& group) {
  const Subassemblies candidates = searcher_.candidates(group);
  Subassemblies list;
  for (const SubassemblyId s : candidates) {
    if (history_.is_worthwhile(group, s, group.search_depth))
      list.push_back(s);
    else
      state_.count("postponed");
  }
  history_.sort_by_cost(group, list, group.search_depth);
  if (searcher_.search_each(group, list, group.search_depth)) return true;
  group.waiting = history_.waiting_of(candidates);
  const bool more_translations =
      group.translations_limited && group.members.size() > 2 && group.search_depth < params_.max_depth;
  const bool deeper = !group.waiting.empty() && group.search_depth < history_.max_depth(group) && !group.is_pair();
  if (more_translations || deeper)
    ++group.search_depth;
  else
    group.searches_exhausted = true;
  return false;
}

void PathSearch::on_group_changed(GroupState& group, const GroupChange&) {
  group.searches_exhausted = group.pair_finished = false;
}

}  // namespace dismantle::blocking
