/// Parts that only a snap fit holds: clips, tyres on rims, arms in shoulders.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "blocking/pair_relaxation.h"
#include "blocking/parameters.h"
#include "blocking_graph/state.h"
#include "blocking_graph/straight_motion.h"
#include "dismantle/motion_depth.h"
#include "dismantle/path_oracle.h"

namespace dismantle::blocking {

/// A part is held by a snap fit when some straight motion out of its group cuts in by little at every pair: by no more
/// than a share of the smaller part, and by less than parts that go through each other's walls. Such parts bend when
/// they are put together. What is free when such parts are off is held so, too. No rigid motion takes most of them
/// out. When a few deep searches of such parts have found nothing, the others are searched for to depth 1 only, and
/// left to forced steps; so are all when there are few and each was searched for deeper, and those that a pair holds
/// that no search separates when all others are taken away. Without forced steps
/// (`run.force: off`, `bench`) no part counts as held so; of two parts alone, only those that are pressed together.
class SnapFits {
 public:
  /// `straight`: null when switched off; then no part counts. `known_before`: an earlier planner of the run has
  /// searched for the parts that are left. All must outlive this.
  SnapFits(const DisassemblyState& state, PathOracle& oracle, StraightMotion* straight, PairRelaxation& relaxation,
           const SnapParameters& params, bool known_before)
      : state_(state),
        oracle_(oracle),
        straight_(straight),
        relaxation_(relaxation),
        params_(params),
        known_before_(known_before) {}

  /// The deepest place of the motion that cuts in least, of those that were measured; nullopt: not held by a snap fit.
  std::optional<MotionDepth> holding(const GroupState& group, SubassemblyId id);
  /// Whether to search to depth 1 only, where `depth` comes next (0: no limit): it is held so, and enough deep searches
  /// of parts that are held so found nothing.
  bool is_snap_fit(const GroupState& group, SubassemblyId id, unsigned depth = 1) {
    return decided(group, id, depth).has_value();
  }
  /// Two parts that snap, and that no search separates when all others are taken away.
  bool is_held_pair(const GroupState& group, SubassemblyId a, SubassemblyId b);
  /// As is_snap_fit(): the place where the snap fit cuts in deepest.
  std::optional<MotionDepth> decided(const GroupState& group, SubassemblyId id, unsigned depth);
  /// Are all parts of the group held so, but for one at most? Then it is no puzzle of translations.
  bool holds_all(const GroupState& group);
  /// Depth to which a group is searched before the snap fits that hold it are left to forced steps; 0: none holds it.
  unsigned depth_of_few(const GroupState& group);
  /// Records a search: what searches of at least `snap_depth` for parts that are held so find, decides for the others.
  void searched(const GroupState& group, SubassemblyId id, unsigned depth, bool found);

 private:
  bool has_evidence() const { return known_before_ || failed_.size() >= params_.snap_failures; }
  bool has_evidence(const GroupState& group);
  bool is_free(const GroupState& group, SubassemblyId id);
  /// It is held by snap fits of pairs, or free when parts that are held so are off; no search separates these pairs.
  std::optional<MotionDepth> held_by_pairs(const GroupState& group, SubassemblyId id);
  /// By motions of this part alone.
  std::optional<MotionDepth> alone(const GroupState& group, SubassemblyId id);
  double deepest_snap(PartId part, PartId other) const;
  std::optional<MotionDepth> measure(const GroupState& group, SubassemblyId id);
  std::optional<MotionDepth> along(const GroupState& group, SubassemblyId id, std::size_t direction,
                                   const Subassemblies& blockers);
  /// How deep a part cuts into one that is in its way, as it leaves; the same in every group of both.
  std::optional<MotionDepth> of_pair(PartId part, PartId other, std::size_t direction, double length);

  struct PairCut {
    Pose part, other;  ///< where they stood
    std::optional<MotionDepth> cut{};
  };

  const DisassemblyState& state_;
  PathOracle& oracle_;
  StraightMotion* straight_;
  PairRelaxation& relaxation_;
  const SnapParameters& params_;
  /// By part and the others of its group, in one arrangement.
  std::map<std::pair<SubassemblyId, Subassemblies>, std::optional<MotionDepth>> known_;
  std::uint64_t arrangement_ = 0;
  std::map<std::tuple<PartId, PartId, std::size_t>, PairCut> pairs_;  ///< the last is the direction
  bool known_before_;                                                 ///< an earlier planner of the run has left parts
  /// Parts whose deep searches found nothing, with the greatest depth, since a search found something.
  std::map<SubassemblyId, unsigned> failed_{};
};

}  // namespace dismantle::blocking
