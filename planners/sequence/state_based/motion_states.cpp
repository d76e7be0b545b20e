#include "state_based/motion_states.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dismantle::state_based {

using Eigen::Vector3d;

MotionStates::MotionStates(blocking::DisassemblyState& state, blocking::StraightMotion& straight,
                           const blocking::PairSweep& sweep, double tolerance, const MotionStateParameters& params)
    : state_(state), straight_(straight), sweep_(sweep), tolerance_(tolerance), params_(params) {}

std::size_t MotionStates::size(SubassemblyId id) const {
  const auto known = states_.find(id);
  return known == states_.end() ? 0 : known->second.size();
}

std::uint64_t MotionStates::states() const {
  std::uint64_t all = 0;
  for (const auto& [id, list] : states_) all += list.size();
  return all;
}

void MotionStates::refuse(SubassemblyId id) { refused_[id].insert(last_.at(id)); }

Subassemblies MotionStates::in_way(const GroupState& group, SubassemblyId id, const State& state,
                                   std::size_t direction) {
  Subassemblies found;
  const PartId part = state_.part_of(id);
  for (const SubassemblyId other : group.members) {
    if (other == id) continue;
    const auto& parts = state_.parts_of(other);
    if (std::any_of(parts.begin(), parts.end(), [&](PartId fixed) {
          return straight_.blocks(straight_.pair_of(part, fixed, direction, state.at));
        }))
      found.push_back(other);
  }
  return found;
}

/// The distance until the part meets the first blocker, which is stored in `translation`.
double MotionStates::free_distance(SubassemblyId id, const State& state, std::size_t direction,
                                   Translation& translation) const {
  const PartId part = state_.part_of(id);
  const Vector3d& d = straight_.directions().all[direction];
  Pose begin = state_.pose(part);
  begin.t += state.at;
  double nearest = std::numeric_limits<double>::infinity();
  for (const SubassemblyId other : translation.in_way)
    for (const PartId fixed : state_.parts_of(other)) {
      const auto passes = [&](double length) {
        Pose end = begin;
        end.t += length * d;
        return sweep_.passes(part, fixed, state_.pose(fixed), {begin, end});
      };
      const double past = straight_.distance_past(straight_.pair_of(part, fixed, direction, state.at));
      double lo = 0, hi = std::min(nearest, past);
      if (!(hi > 0) || passes(hi)) continue;
      for (unsigned k = 0; k < params_.halvings; ++k) {
        const double middle = (lo + hi) / 2;
        (passes(middle) ? lo : hi) = middle;
      }
      nearest = lo;
      translation.first = other;
      if (nearest < least_step(part))
        return nearest;  // too short to be kept, so it does not matter which blocker is first
    }
  return std::max(0.0, nearest - params_.retreat * tolerance_);
}

/// What a part has to travel to be elsewhere depends on its size, not on how finely it is verified.
double MotionStates::least_step(PartId part) const {
  return params_.least_step * state_.assembly().parts[part].mesh->box().size().norm();
}

void MotionStates::add_stops(std::vector<State>& states, std::size_t from, std::size_t direction, double distance,
                             double least) const {
  for (unsigned k = params_.stops; k > 0 && states.size() < params_.states; --k) {
    const double length = distance * k / params_.stops;
    if (length < least) return;
    const Vector3d at = states[from].at + length * straight_.directions().all[direction];
    if (std::none_of(states.begin(), states.end(), [&](const State& s) { return (s.at - at).norm() < least; }))
      states.push_back({at, from});
  }
}

std::optional<std::vector<Vector3d>> MotionStates::path_out(const GroupState& group, SubassemblyId id) {
  std::vector<State>& states = states_[id];
  if (states.empty()) states.push_back({Vector3d::Zero(), 0});
  const std::set<Edge>& refused = refused_[id];
  for (std::size_t s = 0; s < states.size(); ++s)
    for (const std::size_t d : straight_.directions_of(group, id)) {
      if (state_.stop()) return std::nullopt;
      Translation translation = states[s].translations[d];
      if (translation.examined && !translation.in_way.empty() && group.contains(translation.first)) {
        ++kept_;
        continue;
      }
      if (refused.contains({s, d})) continue;
      translation = {true, in_way(group, id, states[s], d), 0};
      if (translation.in_way.empty()) {
        states[s].translations[d] = translation;
        std::vector<Vector3d> path{states[s].at +
                                   straight_.length_out(group, {id}, d, states[s].at) * straight_.directions().all[d]};
        for (std::size_t k = s; k != 0; k = states[k].parent) path.push_back(states[k].at);
        path.emplace_back(Vector3d::Zero());
        std::reverse(path.begin(), path.end());
        last_[id] = {s, d};
        return path;
      }
      translation.first = translation.in_way.front();
      const double distance = free_distance(id, states[s], d, translation);
      states[s].translations[d] = std::move(translation);
      add_stops(states, s, d, distance, least_step(state_.part_of(id)));
    }
  return std::nullopt;
}

std::optional<Subassemblies> MotionStates::fewest_blockers(const GroupState& group, SubassemblyId id,
                                                           SubassemblyId stays) const {
  std::optional<Subassemblies> fewest;
  const auto known = states_.find(id);
  if (known == states_.end()) return fewest;
  for (const State& state : known->second)
    for (const auto& [direction, translation] : state.translations) {
      if (!translation.examined) continue;
      Subassemblies left;
      for (const SubassemblyId other : translation.in_way)
        if (group.contains(other)) left.push_back(other);
      if (std::find(left.begin(), left.end(), stays) != left.end() || (fewest && left.size() >= fewest->size()))
        continue;
      fewest = std::move(left);
    }
  return fewest;
}

}  // namespace dismantle::state_based
