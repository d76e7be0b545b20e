#include "blocking/snap_fits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dismantle/geometry/mesh_measure.h"

namespace dismantle::blocking {

std::optional<MotionDepth> SnapFits::holding(const GroupState& group, SubassemblyId id) {
  if (std::optional<MotionDepth> own = alone(group, id)) return own;
  // What is free when such parts are off is held by them: a hand with a tool, a torso with arms, a plate with wheels.
  if (group.members.size() > params_.snap_group) return std::nullopt;
  GroupState left = group;
  std::optional<MotionDepth> deepest;
  for (bool any = true; any && left.members.size() > 1;) {
    any = false;
    for (const SubassemblyId other : Subassemblies(left.members)) {
      std::optional<MotionDepth> snap = alone(left, other);
      if (!snap) continue;
      if (other == id) return snap;
      std::erase(left.members, other);
      if (!deepest || snap->excess() > deepest->excess()) deepest = std::move(snap);
      any = true;
    }
  }
  return left.members.size() == 1 ? deepest : std::nullopt;
}

std::optional<MotionDepth> SnapFits::decided(const GroupState& group, SubassemblyId id, unsigned depth) {
  if (has_evidence(group)) return holding(group, id);
  if (depth == 1 || group.is_pair()) return std::nullopt;
  if (depth == 0 || depth >= params_.snap_depth_of_few) return held_by_pairs(group, id);
  const std::optional<MotionDepth> own = alone(group, id);
  if (!own || !relaxation_.holds(own->part, own->other)) return std::nullopt;
  failed_[id] = std::max(failed_[id], params_.snap_depth_of_few);  // it was searched for, in effect
  return own;
}

bool SnapFits::is_held_pair(const GroupState& group, SubassemblyId a, SubassemblyId b) {
  const auto by = [&](SubassemblyId id, SubassemblyId other) {
    const std::optional<MotionDepth> snap = alone(group, id);
    return snap && snap->part == state_.part_of(id) && snap->other == state_.part_of(other);
  };
  return state_.is_single(a) && state_.is_single(b) && (by(a, b) || by(b, a)) &&
         relaxation_.holds(state_.part_of(a), state_.part_of(b));
}

bool SnapFits::is_free(const GroupState& group, SubassemblyId id) {
  const std::vector<std::size_t> directions = straight_->directions_of(group, id);
  return std::any_of(directions.begin(), directions.end(),
                     [&](std::size_t d) { return straight_->blockers(group, id, d).empty(); });
}

std::optional<MotionDepth> SnapFits::held_by_pairs(const GroupState& group, SubassemblyId id) {
  if (group.members.size() > params_.snap_group || !holding(group, id)) return std::nullopt;
  GroupState left = group;
  std::optional<MotionDepth> deepest;
  for (bool any = true; any && left.members.size() > 1;) {
    any = false;
    for (const SubassemblyId other : Subassemblies(left.members)) {
      const std::optional<MotionDepth> snap = alone(left, other);
      const bool held = snap && relaxation_.holds(snap->part, snap->other);
      if (state_.context().should_stop()) return std::nullopt;
      if (!held && !(deepest && state_.is_single(other) && is_free(left, other))) continue;
      if (held && (!deepest || snap->excess() > deepest->excess())) deepest = snap;
      if (other == id) return deepest;
      std::erase(left.members, other);
      any = true;
    }
  }
  return left.members.size() == 1 ? deepest : std::nullopt;
}

void SnapFits::searched(const GroupState& group, SubassemblyId id, unsigned depth, bool found) {
  if (has_evidence() || (depth > 0 && depth < params_.snap_depth)) return;
  // Of fewer parts than are evidence only searches that are deeper count: cuts are not measured for others.
  const bool few = state_.assembly().parts.size() < params_.snap_failures;
  if (few && !found && depth > 0 && depth < params_.snap_depth_of_few) return;
  if (!holding(group, id)) return;
  if (found)
    failed_.clear();
  else
    failed_[id] = std::max(failed_[id], depth == 0 ? std::numeric_limits<unsigned>::max() : depth);
}

bool SnapFits::has_evidence(const GroupState& group) {
  if (has_evidence()) return true;
  if (failed_.empty()) return false;
  const auto searched = [&](SubassemblyId id) {
    const auto known = failed_.find(id);
    return known != failed_.end() && known->second >= params_.snap_depth_of_few;
  };
  return std::any_of(group.members.begin(), group.members.end(), searched) &&
         std::all_of(group.members.begin(), group.members.end(),
                     [&](SubassemblyId id) { return searched(id) || !holding(group, id); });
}

unsigned SnapFits::depth_of_few(const GroupState& group) {
  const bool held = std::any_of(group.members.begin(), group.members.end(),
                                [&](SubassemblyId id) { return holding(group, id).has_value(); });
  return held ? params_.snap_depth_of_few : 0;
}

bool SnapFits::holds_all(const GroupState& group) {
  if (group.members.size() > params_.snap_group) return false;
  std::size_t others = 0;
  for (const SubassemblyId id : group.members) {
    if (!holding(group, id)) ++others;
    if (others > 1 || state_.context().should_stop()) return false;
  }
  return true;
}

std::optional<MotionDepth> SnapFits::alone(const GroupState& group, SubassemblyId id) {
  if (!(params_.snap_share > 0) || straight_ == nullptr || oracle_.forcing() == nullptr || !state_.is_single(id))
    return std::nullopt;
  if (arrangement_ != state_.arrangement()) known_.clear();
  arrangement_ = state_.arrangement();
  const std::pair key(id, group.members);
  if (const auto known = known_.find(key); known != known_.end()) return known->second;
  std::optional<MotionDepth> found = measure(group, id);
  if (state_.context().should_stop()) return std::nullopt;
  return known_.emplace(key, std::move(found)).first->second;
}

/// A part that goes through a wall is half of the wall deep in it. A wall of thickness t has a volume of t / 2 times
/// its surface, so half of it is V / A; of a wire, V / A is half of its radius.
double SnapFits::deepest_snap(PartId part, PartId other) const {
  const auto diagonal = [&](PartId p) { return state_.assembly().parts[p].mesh->box().size().norm(); };
  const auto half_wall = [&](PartId p) {
    const Part& of = state_.assembly().parts[p];
    return std::abs(of.volume) / surface_area(*of.mesh);
  };
  const double most = std::min(params_.snap_share * std::min(diagonal(part), diagonal(other)),
                               std::max(half_wall(part), half_wall(other)));
  if (state_.assembly().parts.size() > 2) return most;
  // Two parts alone may be a puzzle, or a thread. What cuts in by twice of what it does when assembled is pressed in;
  // what is deeper than a snap when assembled is cast in.
  const double overlap = state_.assembly().initial_overlap(part, other);
  return overlap < most ? overlap : 0;
}

/// Along the directions with the fewest blockers, which are those of the mating feature: studs, axles, clips.
std::optional<MotionDepth> SnapFits::measure(const GroupState& group, SubassemblyId id) {
  std::vector<std::pair<std::size_t, Subassemblies>> blocked;
  for (const std::size_t d : straight_->directions_of(group, id)) {
    blocked.emplace_back(d, straight_->blockers(group, id, d));
    if (state_.context().should_stop()) return std::nullopt;
  }
  std::stable_sort(blocked.begin(), blocked.end(),
                   [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  if (blocked.size() > params_.snap_directions) blocked.resize(params_.snap_directions);
  for (const auto& [direction, blockers] : blocked)
    if (auto found = along(group, id, direction, blockers)) return found;
  return std::nullopt;
}

std::optional<MotionDepth> SnapFits::along(const GroupState& group, SubassemblyId id, std::size_t direction,
                                           const Subassemblies& blockers) {
  const PartId part = state_.part_of(id);
  const double length = straight_->length_out(group, {id}, direction);
  std::optional<MotionDepth> worst;
  for (const PartId other : state_.parts_of(blockers)) {
    if (deepest_snap(part, other) <= oracle_.tolerance()) return std::nullopt;
    const std::optional<MotionDepth> cut = of_pair(part, other, direction, length);
    if (!cut || state_.context().should_stop()) continue;
    if (cut->excess() > deepest_snap(part, other)) return std::nullopt;
    if (!worst || cut->excess() > worst->excess()) worst = cut;
  }
  return worst;
}

std::optional<MotionDepth> SnapFits::of_pair(PartId part, PartId other, std::size_t direction, double length) {
  const Pose &begin = state_.pose(part), &there = state_.pose(other);
  const auto known = pairs_.find({part, other, direction});
  if (known != pairs_.end() && known->second.part == begin && known->second.other == there) return known->second.cut;
  MotionDepthOptions options;
  options.stop_above = deepest_snap(part, other);
  options.absolute = std::max(0.1 * options.stop_above, oracle_.tolerance());
  options.most_poses = static_cast<std::uint64_t>(params_.snap_poses);
  options.known_invalid = true;
  const Pose end{begin.t + length * straight_->directions().all[direction], begin.q};
  PairCut found{begin, there, {}};
  found.cut = oracle_.forcing()->depth({part}, {{other, there}}, {{begin}, {end}}, options, state_.context());
  if (state_.context().should_stop()) return found.cut;
  return pairs_.insert_or_assign({part, other, direction}, std::move(found)).first->second.cut;
}

}  // namespace dismantle::blocking
