#include "blocking/strategies/postponed_search.h"

#include <algorithm>

namespace dismantle::blocking {

Result PostponedSearch::apply(GroupState& group) {
  if (params_.postponed_searches) {
    Subassemblies list;
    for (const SubassemblyId s : searcher_.candidates(group)) {
      const PastSearch* search = history_.last(s);
      if (search == nullptr || search->group_size != group.members.size()) list.push_back(s);
    }
    if (searcher_.search_each(group, list, group.search_depth)) return Result::restart;
  }
  group.searches_finished = true;
  const auto& waiting = state_.waiting();
  const bool others_search = std::any_of(
      waiting.begin(), waiting.end(), [](const GroupState& g) { return g.members.size() > 1 && !g.searches_finished; });
  return others_search ? Result::defer : Result::unchanged;
}

}  // namespace dismantle::blocking
