/// Two parts of a group with all others taken away.
#pragma once

#include <map>
#include <utility>

#include "blocking_graph/state.h"
#include "dismantle/path_oracle.h"

namespace dismantle::blocking {

/// Searches for a path of one part out of another, as if nothing else were there. Whatever separates the two in their
/// group, alone or simultaneously, is such a path. So a search that finds none says of more attempts, which are dearer,
/// that they are not worthwhile.
class PairRelaxation {
 public:
  /// `depth` of the searches. Both others must outlive this.
  PairRelaxation(const DisassemblyState& state, PathOracle& oracle, unsigned depth)
      : state_(state), oracle_(oracle), depth_(depth) {}

  /// Did the search for the smaller of two parts, where they are now, find no path? It is run once. False when stopped.
  bool holds(PartId a, PartId b);

 private:
  struct Answer {
    Pose first, second;  ///< where the parts were
    bool holds = false;
  };
  bool search(PartId a, PartId b);

  const DisassemblyState& state_;
  PathOracle& oracle_;
  unsigned depth_;
  std::map<std::pair<PartId, PartId>, Answer> known_;
};

}  // namespace dismantle::blocking
