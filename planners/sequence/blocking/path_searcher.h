/// Calls the path planner for single parts, one after the other, until a part leaves.
#pragma once

#include "blocking/lookahead.h"
#include "blocking/snap_fits.h"
#include "blocking_graph/straight_motion.h"

namespace dismantle::blocking {

class PathSearcher {
 public:
  /// `straight`: null when switched off. All must outlive this.
  PathSearcher(DisassemblyState& state, SearchHistory& history, const Lookahead& lookahead, PathOracle& oracle,
               StraightMotion* straight, SnapFits& snaps);

  /// Single parts that may leave. Parts whose removal would free others come first, because such a success saves many
  /// expensive searches. The housing comes last.
  Subassemblies candidates(const GroupState& group);
  /// Searches for a path of each of `ids` in order, until one leaves. True: one has left.
  bool search_each(GroupState& group, const Subassemblies& ids, unsigned depth);

 private:
  void sort_by_use(const GroupState& group, Subassemblies& ids);
  bool search(GroupState& group, SubassemblyId id, unsigned depth, const Subassemblies& next);

  DisassemblyState& state_;
  SearchHistory& history_;
  const Lookahead& lookahead_;
  PathOracle& oracle_;
  StraightMotion* straight_;
  SnapFits& snaps_;
};

}  // namespace dismantle::blocking
