/// One run of the `blocking` planner: the state, the objects that the strategies share, and the list of strategies.
#pragma once

#include <memory>
#include <vector>

#include "blocking/blocking.h"
#include "blocking/path_searcher.h"
#include "blocking_graph/stated_groups.h"
#include "blocking_graph/strategy_list.h"

namespace dismantle::blocking {

class Run {
 public:
  Run(const BlockingParameters& params, const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
      RunContext& context);
  SequenceResult run();
  /// In the order in which they are tried.
  const std::vector<std::unique_ptr<Strategy>>& strategies() const { return list_.strategies(); }

 private:
  void make_strategies();

  const BlockingParameters& params_;
  PathOracle& oracle_;
  DisassemblyState state_;
  SearchHistory history_;
  StatedGroups stated_;
  std::unique_ptr<PairSweep> sweep_;          // null without geometry
  std::unique_ptr<StraightMotion> straight_;  // null when switched off, or without geometry
  std::unique_ptr<Lookahead> lookahead_;
  PairRelaxation relaxation_;
  std::unique_ptr<SnapFits> snaps_;
  std::unique_ptr<PathSearcher> searcher_;
  StrategyList list_;
};

}  // namespace dismantle::blocking
