/// Rounds of searches by the path planner: every part to a small depth, then deeper (Tian et al. 2022, Algorithm 2).
#pragma once

#include "blocking/path_searcher.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

class PathSearch final : public Strategy {
 public:
  PathSearch(DisassemblyState& state, SearchHistory& history, PathSearcher& searcher,
             const PathSearchParameters& params)
      : state_(state), history_(history), searcher_(searcher), params_(params) {}
  std::string_view name() const noexcept override { return "path_search"; }
  Cost cost() const noexcept override { return Cost::limited_search; }
  Result apply(GroupState& group) override;
  void on_group_changed(GroupState& group, const GroupChange& change) override;

 private:
  bool round(GroupState& group);

  DisassemblyState& state_;
  SearchHistory& history_;
  PathSearcher& searcher_;
  const PathSearchParameters& params_;
};

}  // namespace dismantle::blocking
