#include "blocking/strategies/rotation_in_place.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace dismantle::blocking {
Pose RotationInPlace::Rotation::at(double angle) const {
  const Eigen::Vector3d point = start * axis.point, direction = start.q * axis.direction;
  const Eigen::Quaterniond q(Eigen::AngleAxisd(sense * angle, direction));
  return {point + q * (start.t - point), (q * start.q).normalized()};
}

/// Waits for the first round of path searches, which costs less than rotation.
Result RotationInPlace::apply(GroupState& group) {
  if (group.members.size() < 3 || done_[group] || (group.search_depth == 1 && !group.searches_exhausted))
    return Result::unchanged;
  if (rotate_any(group)) return Result::restart;
  done_[group] = true;
  return Result::unchanged;
}

bool RotationInPlace::rotate_any(GroupState& group) {
  sweeps_ = 0;
  for (const SubassemblyId id : Subassemblies(group.members)) {
    if (!state_.is_single(id) || state_.is_base(state_.part_of(id))) continue;
    const auto [entry, is_new] = axes_.try_emplace(state_.part_of(id));
    if (is_new)
      entry->second = rotation_axes(*state_.assembly().parts[state_.part_of(id)].mesh, params_.rotation_axes,
                                    {params_.round_facets, params_.round_share, oracle_.tolerance()});
    for (const RotationAxis& axis : entry->second)
      if (rotate(group, id, axis)) return true;
  }
  return false;
}

double RotationInPlace::arc() const { return 2 * std::numbers::pi / params_.rotation_stops; }

/// Rotates about the axis in both senses until another subassembly is free.
bool RotationInPlace::rotate(GroupState& group, SubassemblyId id, const RotationAxis& axis) {
  for (const int sense : {1, -1}) {
    const Rotation rotation{id, axis, state_.pose(state_.part_of(id)), sense};
    Path path{{rotation.start}};
    bool met = false;
    for (unsigned stop = 1; stop < params_.rotation_stops && !met; ++stop) {
      if (state_.stop() || limit_reached()) return false;
      const std::size_t length = path.size();
      met = !step(group, rotation, stop, path);
      if (path.size() == length) break;
      const auto freed = freed_at(group, id, path.back().front());
      if (!freed) continue;
      if (!commit(group, id, path)) break;
      straight_.leave(group, {freed->first}, freed->second);  // if that is refused, the next round tries again
      return true;
    }
    if (!met) break;  // a full turn covers the other sense; or the oracle refused
  }
  return false;
}

/// Appends the pose of the next stop to `path`. False: the part meets another one before. Then the last pose before
/// contact is appended, if the part gets any further.
bool RotationInPlace::step(const GroupState& group, const Rotation& rotation, unsigned stop, Path& path) {
  const Pose last = path.back().front();
  const Pose next = rotation.at(stop * arc());
  if (sweeps_clear(group, rotation.id, last, next)) {
    path.push_back({next});
    return true;
  }
  double clear = 0, blocked = arc();
  for (unsigned h = 0; h < params_.rotation_halvings; ++h) {
    const double middle = 0.5 * (clear + blocked);
    (sweeps_clear(group, rotation.id, last, rotation.at((stop - 1) * arc() + middle)) ? clear : blocked) = middle;
  }
  if (clear > 0) path.push_back({rotation.at((stop - 1) * arc() + clear)});
  return false;
}

/// Can the part move along the short arc from one pose to the other?
bool RotationInPlace::sweeps_clear(const GroupState& group, SubassemblyId id, const Pose& from, const Pose& to) {
  for (const SubassemblyId other : group.members) {
    if (other == id) continue;
    for (const PartId fixed : state_.parts_of(other)) {
      ++sweeps_;
      if (!arc_passes(state_.part_of(id), from, to, fixed)) return false;
    }
  }
  return true;
}

/// Cached: the answer depends on these two parts alone, and is needed again whenever another part has left.
bool RotationInPlace::arc_passes(PartId part, const Pose& from, const Pose& to, PartId fixed) {
  const Pose& there = state_.pose(fixed);
  std::vector<double> key{static_cast<double>(part), static_cast<double>(fixed)};
  for (const Pose* p : {&from, &to, &there}) {
    key.insert(key.end(), p->t.begin(), p->t.end());
    key.insert(key.end(), p->q.coeffs().begin(), p->q.coeffs().end());
  }
  if (const auto known = arcs_.find(key); known != arcs_.end()) return known->second;
  const bool passes = sweep_.passes(part, fixed, there, {from, to});
  return arcs_.emplace(std::move(key), passes).first->second;
}

/// Which other could leave, and in which direction, with `id` at `pose`? A rotation is reported only once.
std::optional<std::pair<SubassemblyId, std::size_t>> RotationInPlace::freed_at(const GroupState& group,
                                                                               SubassemblyId id, const Pose& pose) {
  const PartId part = state_.part_of(id);
  const Pose start = state_.pose(part);
  state_.set_pose(part, pose);
  const std::pair key{group.members, std::pair{id, state_.orientation(part)}};
  auto freed = tried_.contains(key) ? std::nullopt : freed_by(group, id);
  state_.set_pose(part, start);
  if (freed) tried_.insert(key);
  return freed;
}

/// Examines only subassemblies and directions that `id` blocked. Rotations that free the part itself are left to the
/// path planner.
std::optional<std::pair<SubassemblyId, std::size_t>> RotationInPlace::freed_by(const GroupState& group,
                                                                               SubassemblyId id) {
  for (const SubassemblyId other : group.members) {
    if (other == id || !state_.may_leave(group, {other})) continue;
    for (const std::size_t d : straight_.directions_of(group, other)) {
      if (state_.stop() || limit_reached()) return std::nullopt;
      // A different blocker stays where it is. If `id` still blocks, it is remembered as before.
      if (!straight_.forget_blocker(other, d, id)) continue;
      for (auto open = straight_.open_pairs(group, other, d); !open.empty();
           open = straight_.open_pairs(group, other, d)) {
        ++sweeps_;
        straight_.blocks(open.front());
      }
      if (!straight_.is_blocked(other, d)) return std::pair(other, d);
    }
  }
  return std::nullopt;
}

/// Proposes the rotation to the oracle. The part stays there if it is accepted.
bool RotationInPlace::commit(GroupState& group, SubassemblyId id, const Path& path) {
  Attempt attempt = state_.attempt_for(group, {id});
  attempt.goal.placement = true;
  const AttemptResult& answer = oracle_.propose(attempt, path, state_.context());
  if (!is_success(answer.result.outcome())) return false;
  state_.commit(group, {id}, attempt, answer, GroupChange::Kind::rotated);
  state_.count("rotations");
  return true;
}

}  // namespace dismantle::blocking
