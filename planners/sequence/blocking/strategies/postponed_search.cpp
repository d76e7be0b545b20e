#include "blocking/strategies/postponed_search.h"

namespace dismantle::blocking {

Result PostponedSearch::apply(GroupState& group) {
  if (params_.postponed_searches && group.proof == nullptr) {
    Subassemblies list;
    for (const SubassemblyId s : searcher_.candidates(group)) {
      const PastSearch* search = history_.last(s);
      if (search == nullptr || search->group_size != group.members.size()) list.push_back(s);
    }
    if (searcher_.search_each(group, list, group.search_depth)) return Result::restart;
  }
  return Result::unchanged;
}

}  // namespace dismantle::blocking
