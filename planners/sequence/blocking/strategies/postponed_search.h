/// Makes the searches that were postponed because the parts that they had touched were still in the group. So no group
/// is given up before each of its parts was searched for in the group as it is.
#pragma once

#include "blocking/path_searcher.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

class PostponedSearch final : public Strategy {
 public:
  PostponedSearch(DisassemblyState& state, const SearchHistory& history, PathSearcher& searcher,
                  const PathSearchParameters& params)
      : state_(state), history_(history), searcher_(searcher), params_(params) {}
  std::string_view name() const noexcept override { return "postponed_search"; }
  Cost cost() const noexcept override { return Cost::unlimited_search; }
  Result apply(GroupState& group) override;

 private:
  DisassemblyState& state_;
  const SearchHistory& history_;
  PathSearcher& searcher_;
  const PathSearchParameters& params_;
};

}  // namespace dismantle::blocking
