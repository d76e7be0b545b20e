/// Parts that only a snap fit holds: clips, tyres on rims, arms in shoulders.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "blocking/params.h"
#include "blocking_graph/state.h"
#include "blocking_graph/straight_motion.h"
#include "dismantle/motion_depth.h"
#include "dismantle/path_oracle.h"

namespace dismantle::blocking {

/// A part is held by a snap fit when some straight motion out of its group cuts in by little at every pair: by no more
/// than a share of the smaller part, and by less than parts that go through each other's walls. Such parts bend when
/// they are put together. A part is held so, too, if all others of its group are. No rigid motion takes most of them
/// out, so they are searched for to depth 1 only, and left to forced steps. Without these (`run.force: off`, `bench`)
/// no part counts as held so, nor in an assembly of two parts.
class SnapFits {
 public:
  /// `straight`: null when switched off; then no part counts. All must outlive this.
  SnapFits(const DisassemblyState& state, PathOracle& oracle, StraightMotion* straight, const SnapParams& params)
      : state_(state), oracle_(oracle), straight_(straight), params_(params) {}

  /// The deepest place of the motion that cuts in least, of those that were measured; nullopt: not held by a snap fit.
  std::optional<MotionDepth> holding(const GroupState& group, SubassemblyId id);
  bool holds(const GroupState& group, SubassemblyId id) { return holding(group, id).has_value(); }

 private:
  /// By motions of this part alone.
  std::optional<MotionDepth> alone(const GroupState& group, SubassemblyId id);
  double deepest_snap(PartId part, PartId other) const;
  std::optional<MotionDepth> measure(const GroupState& group, SubassemblyId id);
  std::optional<MotionDepth> along(const GroupState& group, SubassemblyId id, std::size_t direction,
                                   const Subassemblies& blockers);

  const DisassemblyState& state_;
  PathOracle& oracle_;
  StraightMotion* straight_;
  const SnapParams& params_;
  /// By part and the others of its group, in one arrangement.
  std::map<std::pair<SubassemblyId, Subassemblies>, std::optional<MotionDepth>> known_;
  std::uint64_t arrangement_ = 0;
};

}  // namespace dismantle::blocking
