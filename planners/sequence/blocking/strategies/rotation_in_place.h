/// Rotates a part about the axis of one of its round surfaces, and leaves it rotated if that frees another part: a
/// latch, a bayonet, a disc under a slider.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "blocking/parameters.h"
#include "blocking/rotation_axes.h"
#include "blocking_graph/straight_motion.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

class RotationInPlace final : public Strategy {
 public:
  RotationInPlace(DisassemblyState& state, PathOracle& oracle, StraightMotion& straight, const PairSweep& sweep,
                  const RotationParameters& params)
      : state_(state), oracle_(oracle), straight_(straight), sweep_(sweep), params_(params) {}
  std::string_view name() const noexcept override { return "rotation_in_place"; }
  Cost cost() const noexcept override { return Cost::arc_sweeps; }
  Result apply(GroupState& group) override;
  void on_group_changed(GroupState& group, const GroupChange&) override { done_[group] = false; }

 private:
  /// A rotation of one part about one axis.
  struct Rotation {
    SubassemblyId id = 0;
    RotationAxis axis;
    Pose start;
    int sense = 1;  ///< of the rotation about the axis, 1 or -1

    Pose at(double angle) const;  ///< rad
  };
  bool rotate_any(GroupState& group);
  bool rotate(GroupState& group, SubassemblyId id, const RotationAxis& axis);
  bool step(const GroupState& group, const Rotation& rotation, unsigned stop, Path& path);
  double arc() const;  ///< rad, from one stop to the next
  bool sweeps_clear(const GroupState& group, SubassemblyId id, const Pose& from, const Pose& to);
  bool arc_passes(PartId part, const Pose& from, const Pose& to, PartId fixed);
  std::optional<std::pair<SubassemblyId, std::size_t>> freed_at(const GroupState& group, SubassemblyId id,
                                                                const Pose& pose);
  std::optional<std::pair<SubassemblyId, std::size_t>> freed_by(const GroupState& group, SubassemblyId id);
  bool commit(GroupState& group, SubassemblyId id, const Path& path);
  bool limit_reached() const { return sweeps_ > params_.rotation_sweeps; }

  DisassemblyState& state_;
  PathOracle& oracle_;
  StraightMotion& straight_;
  const PairSweep& sweep_;
  const RotationParameters& params_;
  PerGroup<bool> done_;
  std::map<PartId, std::vector<RotationAxis>> axes_;
  /// Rotations that have already freed another part: members of the group, part, orientation.
  std::set<std::pair<Subassemblies, std::pair<SubassemblyId, std::size_t>>> tried_;
  std::map<std::vector<double>, bool> arcs_;  // by two parts and three poses
  unsigned sweeps_ = 0;                       // since the last change of the group
};

}  // namespace dismantle::blocking
