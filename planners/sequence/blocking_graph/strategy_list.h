/// Takes an assembly apart by a list of strategies: what the planners that know groups have in common.
#pragma once

#include <memory>
#include <vector>

#include "blocking_graph/report.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

/// Pairs whose overlap proves that no motion can separate them.
InseparablePairs overlap_locks(const Assembly& assembly, PathOracle& oracle, const RunContext& context);

class StrategyList {
 public:
  /// Both must outlive this.
  StrategyList(DisassemblyState& state, PathOracle& oracle) : state_(state), report_(state, oracle) {}
  /// Behind those that were added before. It is told of every change.
  void add(std::unique_ptr<Strategy> strategy);
  /// In the order in which they are tried.
  const std::vector<std::unique_ptr<Strategy>>& strategies() const { return strategies_; }
  /// Until all groups are taken apart or given up, or the run is to stop. In each group one strategy after the other is
  /// tried; after a change the first again.
  SequenceResult run();

 private:
  void take_apart(GroupState group);

  DisassemblyState& state_;
  Report report_;
  std::vector<std::unique_ptr<Strategy>> strategies_;
};

}  // namespace dismantle::blocking
