/// Searches for the paths of single parts by the path planner, one after the other, until one leaves.
#pragma once

#include "blocking/lookahead.h"
#include "blocking_graph/straight_motion.h"

namespace dismantle::blocking {

class PathSearcher {
 public:
  /// `straight`: null when switched off. All must outlive this.
  PathSearcher(DisassemblyState& state, SearchHistory& history, const Lookahead& lookahead, PathOracle& oracle,
               StraightMotion* straight);

  /// Single parts that may leave. Those whose removal would free others come first, the housing last: searches are
  /// expensive, and a success makes many of them needless.
  Subassemblies candidates(const GroupState& group);
  /// Until one of `ids` leaves; true then.
  bool search_each(GroupState& group, const Subassemblies& ids, unsigned depth);

 private:
  void sort_by_use(const GroupState& group, Subassemblies& ids);
  bool search(GroupState& group, SubassemblyId id, unsigned depth, const Subassemblies& next);

  DisassemblyState& state_;
  SearchHistory& history_;
  const Lookahead& lookahead_;
  PathOracle& oracle_;
  StraightMotion* straight_;
};

}  // namespace dismantle::blocking
