/// Disassembles by a list of strategies: shared by the sequence planners that work on groups.
#pragma once

#include <memory>
#include <vector>

#include "blocking_graph/report.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

/// Pairs whose overlap proves that no motion can separate them.
InseparablePairs overlap_locks(const SequenceQuery& query, PathOracle& oracle, const RunContext& context);

class StrategyList {
 public:
  /// Both must outlive this.
  StrategyList(DisassemblyState& state, PathOracle& oracle) : state_(state), report_(state, oracle) {}
  /// Appends a strategy, and makes it a listener of every change.
  void add(std::unique_ptr<Strategy> strategy);
  /// In the order in which they are tried.
  const std::vector<std::unique_ptr<Strategy>>& strategies() const { return strategies_; }
  /// Runs until all groups are disassembled or given up, or the run is to stop. In each group the strategies are tried
  /// in order, and from the first again after a change.
  SequenceResult run();

 private:
  void take_apart(GroupState group);

  DisassemblyState& state_;
  Report report_;
  std::vector<std::unique_ptr<Strategy>> strategies_;
};

}  // namespace dismantle::blocking
