/// Path searches for the last two subassemblies of a group: deeper each time, in the end without a depth limit.
#pragma once

#include "blocking/path_searcher.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

class PairSearch final : public Strategy {
 public:
  PairSearch(DisassemblyState& state, SearchHistory& history, PathSearcher& searcher, const Lookahead& lookahead,
             SnapFits& snaps, const PathSearchParameters& params)
      : state_(state), history_(history), searcher_(searcher), lookahead_(lookahead), snaps_(snaps), params_(params) {}
  std::string_view name() const noexcept override { return "pair_search"; }
  Cost cost() const noexcept override { return Cost::unlimited_search; }
  Result apply(GroupState& group) override;

 private:
  bool search(GroupState& group);
  unsigned next_depth(const GroupState& group);

  DisassemblyState& state_;
  SearchHistory& history_;
  PathSearcher& searcher_;
  const Lookahead& lookahead_;
  SnapFits& snaps_;
  const PathSearchParameters& params_;
};

}  // namespace dismantle::blocking
