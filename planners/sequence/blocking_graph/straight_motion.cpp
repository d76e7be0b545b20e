#include "blocking_graph/straight_motion.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace dismantle::blocking {
namespace {

constexpr std::size_t kWave = 4;    // directions of one part that are examined together, the shortest path first
constexpr std::size_t kHints = 12;  // directions in one hint to idle threads; never changes a plan

}  // namespace

StraightMotion::StraightMotion(DisassemblyState& state, PathOracle& oracle, const PairSweep& sweep,
                               Directions directions)
    : state_(state),
      oracle_(oracle),
      sweep_(sweep),
      directions_(std::move(directions)),
      relations_(sweep, directions_, state.orientations(), state.context().executor),
      extents_(state, relations_, directions_.all.size()),
      blocker_(state.subassemblies()) {}

void StraightMotion::on_group_changed(GroupState&, const GroupChange& change) {
  refused_.clear();
  keep_far_ends(change);
  extents_.moved(change.moved);
  if (change.moves_remaining())  // remembered blockers may have moved away
    for (auto& known : blocker_) known.clear();
  else
    for (const SubassemblyId s : change.moved) blocker_[s].clear();
}

Pair StraightMotion::pair_of(PartId moving, PartId fixed, std::size_t direction, const Eigen::Vector3d& shift) const {
  return {moving,
          fixed,
          direction,
          state_.pose(moving).t + shift - state_.pose(fixed).t,
          state_.orientation(moving),
          state_.orientation(fixed)};
}

/// Pairs of parts that decide together whether `moving` can pass `fixed`.
std::vector<Pair> StraightMotion::pairs_of(SubassemblyId moving, SubassemblyId fixed, std::size_t direction) const {
  std::vector<Pair> pairs;
  for (const PartId a : state_.parts_of(moving))
    for (const PartId b : state_.parts_of(fixed)) {
      const Pair pair = pair_of(a, b, direction);
      if (!relations_.far(pair)) pairs.push_back(pair);
    }
  return pairs;
}

Subassemblies StraightMotion::blockers(const GroupState& group, SubassemblyId id, std::size_t direction) {
  std::vector<Pair> pairs;
  for (const SubassemblyId other : extents_.near(group.members, id, direction))
    for (const Pair& pair : pairs_of(id, other, direction)) pairs.push_back(pair);
  relations_.compute(pairs);
  Subassemblies found;
  for (const Pair& pair : pairs)
    if (relations_.blocks(pair) && (found.empty() || found.back() != state_.subassembly_of(pair.fixed)))
      found.push_back(state_.subassembly_of(pair.fixed));
  return found;
}

/// Distance along the direction until the extents of the two parts meet: the nearest part is the likeliest blocker.
double StraightMotion::gap_of(const Pair& p) const {
  return relations_.extent(p.fixed, p.direction, p.orientation_fixed).first -
         relations_.extent(p.moving, p.direction, p.orientation_moving).second -
         p.offset.dot(directions_.all[p.direction]);
}

Subassemblies StraightMotion::fewest_blockers(const GroupState& group, SubassemblyId id,
                                              std::span<const std::size_t> directions) {
  Subassemblies fewest;
  bool found = false;
  for (const std::size_t d : directions) {
    const Subassemblies blocked_by = blockers(group, id, d);
    if (state_.stop()) return {};
    if (!found || blocked_by.size() < fewest.size()) fewest = blocked_by;
    found = true;
  }
  return fewest;
}

bool StraightMotion::forget_blocker(SubassemblyId id, std::size_t direction, SubassemblyId blocker) {
  const auto known = blocker_[id].find(direction);
  if (known == blocker_[id].end() || known->second != blocker) return false;
  blocker_[id].erase(known);
  return true;
}

bool StraightMotion::was_refused(const Subassemblies& ids, std::size_t direction) const {
  return refused_.contains({state_.parts_of(ids), direction});
}

/// Cached, because every subassembly asks for its directions: visiting all others each time would be quadratic.
const StraightMotion::FarEnd& StraightMotion::far_end(const GroupState& group, std::size_t direction) const {
  const bool same_arrangement = far_ends_.arrangement == state_.arrangement();
  if (!same_arrangement || far_ends_.group != group.id) {  // a group is the same as long as nothing moves
    if (!same_arrangement || far_ends_.members != group.members)
      far_ends_ = {state_.arrangement(), {}, group.members, {}};
    far_ends_.group = group.id;
  }
  const auto [at, is_new] = far_ends_.by_direction.try_emplace(direction);
  FarEnd& far = at->second;
  if (!is_new) return far;
  const Eigen::Vector3d& d = directions_.all[direction];
  for (const SubassemblyId u : group.members)
    for (const PartId id : state_.parts_of(u)) {
      const double end = relations_.extent(id, direction, state_.orientation(id)).second + state_.pose(id).t.dot(d);
      if (end > far.end) {
        if (u != far.farthest) {
          far.next = far.farthest;
          far.next_end = far.end;
        }
        far.farthest = u;
        far.end = end;
      } else if (u != far.farthest && end > far.next_end) {
        far.next = u;
        far.next_end = end;
      }
    }
  return far;
}

/// A removed subassembly was rarely a far end, so most far ends stay valid.
void StraightMotion::keep_far_ends(const GroupChange& change) {
  const std::size_t moved = state_.parts_of(change.moved).size();
  if (change.kind != GroupChange::Kind::removed || far_ends_.arrangement + moved != state_.arrangement()) return;
  const auto has_left = [&](SubassemblyId u) {
    return std::find(change.moved.begin(), change.moved.end(), u) != change.moved.end();
  };
  far_ends_.arrangement = state_.arrangement();
  far_ends_.group.reset();
  std::erase_if(far_ends_.members, has_left);
  std::erase_if(far_ends_.by_direction,
                [&](const auto& entry) { return has_left(entry.second.farthest) || has_left(entry.second.next); });
}

double StraightMotion::path_length(const GroupState& group, const Subassemblies& ids, std::size_t direction,
                                   const Eigen::Vector3d& shift) const {
  const Eigen::Vector3d& d = directions_.all[direction];
  double ours = std::numeric_limits<double>::infinity(), theirs = -ours;
  for (const SubassemblyId u : ids)
    for (const PartId id : state_.parts_of(u))
      ours = std::min(ours, relations_.extent(id, direction, state_.orientation(id)).first + state_.pose(id).t.dot(d));
  if (ids.size() == 1) {
    const FarEnd& far = far_end(group, direction);
    theirs = far.farthest == ids.front() ? far.next_end : far.end;
  } else {
    for (const SubassemblyId u : group.members) {
      if (std::find(ids.begin(), ids.end(), u) != ids.end()) continue;
      for (const PartId id : state_.parts_of(u))
        theirs = std::max(theirs,
                          relations_.extent(id, direction, state_.orientation(id)).second + state_.pose(id).t.dot(d));
    }
  }
  return std::max(0.0, theirs - ours - shift.dot(d));
}

bool StraightMotion::admits(DirectionFilter filter, std::size_t direction) const {
  constexpr double kSteep = 0.7;
  const double upwards = directions_.all[direction].dot(state_.up());
  return filter == DirectionFilter::any || upwards > (filter == DirectionFilter::up ? kSteep : -kSteep);
}

std::vector<std::size_t> StraightMotion::own_directions(SubassemblyId unit) const {
  std::vector<std::size_t> list;
  for (const PartId id : state_.parts_of(unit)) {
    const auto& of_part = directions_.of_part[id];
    list.insert(list.end(), of_part.begin(), of_part.end());
  }
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

std::vector<std::size_t> StraightMotion::directions_of(const GroupState& group, SubassemblyId unit) const {
  std::vector<std::size_t> list = own_directions(unit);
  std::vector<std::pair<double, std::size_t>> lengths;
  for (const std::size_t d : list) lengths.emplace_back(path_length(group, {unit}, d), d);
  std::stable_sort(lengths.begin(), lengths.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first - 1e-9; });
  list.clear();
  for (const auto& [length, d] : lengths) list.push_back(d);
  return list;
}

std::vector<Pair> StraightMotion::open_pairs(const GroupState& group, SubassemblyId unit, std::size_t direction) {
  const auto known = blocker_[unit].find(direction);
  if (known != blocker_[unit].end()) {
    if (group.contains(known->second)) return {};  // that blocker is still in the group
    blocker_[unit].erase(known);
  }
  const auto [blocker, pairs] = examine(group, unit, direction);
  if (blocker) blocker_[unit][direction] = *blocker;
  return pairs;
}

/// A subassembly that is known to block; if there is none, the pairs whose relation is not known.
std::pair<std::optional<SubassemblyId>, std::vector<Pair>> StraightMotion::examine(const GroupState& group,
                                                                                   SubassemblyId unit,
                                                                                   std::size_t direction) const {
  std::vector<std::pair<double, Pair>> unknown;  // by gap
  for (const SubassemblyId other : extents_.near(group.members, unit, direction)) {
    for (const Pair& pair : pairs_of(unit, other, direction)) {
      if (relations_.known(pair)) {
        if (!relations_.known_to_block(pair)) continue;
        return {other, {}};
      }
      unknown.emplace_back(gap_of(pair), pair);
    }
  }
  std::stable_sort(unknown.begin(), unknown.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Pair> pairs;
  for (const auto& [gap, pair] : unknown) pairs.push_back(pair);
  return {std::nullopt, std::move(pairs)};
}

/// Examines the directions in waves of kWave, until one is free.
void StraightMotion::resolve(const GroupState& group, SubassemblyId unit, const std::vector<std::size_t>& directions,
                             std::span<const SubassemblyId> next) {
  for (std::size_t first = 0; first < directions.size() && !state_.stop();) {
    const std::size_t last = std::min(first + kWave, directions.size());
    std::vector<Pair> questions;
    bool free = false;
    for (std::size_t k = first; k < last; ++k) {
      if (const auto open = open_pairs(group, unit, directions[k]); !open.empty())
        questions.push_back(open.front());
      else
        free = free || !blocker_[unit].contains(directions[k]);
    }
    if (!questions.empty()) {
      if (relations_.wants_hints()) hint(group, std::span(directions).subspan(first), unit, next);
      relations_.compute(questions);
    } else {
      if (free) return;
      first = last;
    }
  }
}

/// Hints at the pairs that will probably be asked for: those of `unit` in these directions, then those of the first
/// undecided directions of the next subassemblies.
void StraightMotion::hint(const GroupState& group, std::span<const std::size_t> directions, SubassemblyId unit,
                          std::span<const SubassemblyId> next) {
  std::vector<std::vector<Pair>> lists;
  const auto add = [&](SubassemblyId u, std::size_t direction) {
    auto list = open_pairs(group, u, direction);
    if (list.empty()) return false;
    lists.push_back(std::move(list));
    return true;
  };
  for (const std::size_t d : directions)
    if (lists.size() < kHints) add(unit, d);
  for (const SubassemblyId u : next) {
    if (lists.size() >= kHints) break;
    std::size_t open = 0;
    for (const std::size_t d : directions_of(group, u)) {
      if (open == kWave || lists.size() >= kHints) break;
      if (add(u, d))
        ++open;
      else if (!blocker_[u].contains(d))
        break;  // free
    }
  }
  relations_.hint(lists);
}

/// Hints at the pairs that will be asked for when `ids` have left: directions in which only these are known to block,
/// and directions that were not examined yet.
void StraightMotion::hint_after_removal(const GroupState& group, const Subassemblies& ids) {
  GroupState left = group;
  std::erase_if(left.members, [&](SubassemblyId u) { return std::find(ids.begin(), ids.end(), u) != ids.end(); });
  std::vector<std::vector<Pair>> lists;
  for (const SubassemblyId u : left.members) {
    const auto blocked = [&](std::size_t d) {
      const auto known = blocker_[u].find(d);
      return known != blocker_[u].end() && left.contains(known->second);
    };
    const std::vector<std::size_t> own = own_directions(u);
    if (std::all_of(own.begin(), own.end(), blocked) || !state_.may_leave(left, {u})) continue;
    std::size_t open = 0;
    for (const std::size_t d : directions_of(left, u)) {
      if (open == kWave || lists.size() == kHints) break;
      if (blocked(d)) continue;
      auto [blocker, pairs] = examine(left, u, d);
      if (blocker) continue;
      if (pairs.empty()) break;  // free
      lists.push_back(std::move(pairs));
      ++open;
    }
    if (lists.size() == kHints) break;
  }
  relations_.hint(lists);
}

std::optional<std::size_t> StraightMotion::free_direction(const GroupState& group, SubassemblyId unit,
                                                          std::span<const SubassemblyId> next, DirectionFilter filter) {
  std::vector<std::size_t> directions = directions_of(group, unit);
  std::erase_if(directions, [&](std::size_t d) { return !admits(filter, d); });
  resolve(group, unit, directions, next);
  if (state_.stop()) return std::nullopt;
  for (const std::size_t d : directions) {
    if (blocker_[unit].contains(d) || was_refused({unit}, d)) continue;
    // Directions stay undecided if an earlier wave had a free one, which the verifier then refused.
    if (!open_pairs(group, unit, d).empty()) continue;
    if (!blocker_[unit].contains(d)) return d;
  }
  return std::nullopt;
}

std::vector<std::size_t> StraightMotion::free_directions(const GroupState& group, SubassemblyId unit) {
  std::vector<std::size_t> found;
  for (const std::size_t d : directions_of(group, unit)) {
    for (auto open = open_pairs(group, unit, d); !open.empty(); open = open_pairs(group, unit, d)) {
      if (state_.stop()) return {};
      relations_.compute(open);
    }
    if (!blocker_[unit].contains(d) && !was_refused({unit}, d)) found.push_back(d);
  }
  return found;
}

double StraightMotion::length_out(const GroupState& group, const Subassemblies& ids, std::size_t direction,
                                  const Eigen::Vector3d& shift) const {
  return length_out(group, ids, direction, state_.attempt_for(group, ids), shift);
}

/// The same for the attempt to remove `ids`.
double StraightMotion::length_out(const GroupState& group, const Subassemblies& ids, std::size_t direction,
                                  const Attempt& attempt, const Eigen::Vector3d& shift) const {
  std::vector<PlacedPart> moving = attempt.moving;
  for (PlacedPart& p : moving) p.pose.t += shift;
  // Ends one tolerance further: poses are rounded when they are written.
  const double most = path_length(group, ids, direction, shift) + 0.1 * sweep_.tolerance();
  return sweep_.distance_apart(moving, attempt.fixed, directions_.all[direction], most) + sweep_.tolerance();
}

bool StraightMotion::leave(GroupState& group, const Subassemblies& ids, std::size_t direction) {
  const Attempt attempt = state_.attempt_for(group, ids);
  const Eigen::Vector3d& d = directions_.all[direction];
  const double length = length_out(group, ids, direction, attempt, Eigen::Vector3d::Zero());
  Path path(2);
  for (const auto& p : attempt.moving) {
    path[0].push_back(p.pose);
    path[1].push_back({p.pose.t + length * d, p.pose.q});
  }
  const PartId first = attempt.moving.front().part;
  state_.show_progress(first);
  if (relations_.works_ahead()) hint_after_removal(group, ids);
  RunContext& context = state_.context();
  const AttemptResult& answer = oracle_.propose(attempt, path, context);
  context.log(LogLevel::debug, "straight path of '" + state_.assembly().parts[first].name + "' and " +
                                   std::to_string(attempt.moving.size() - 1) +
                                   " more: " + std::string(to_string(answer.result.outcome())) + ", " +
                                   std::to_string(answer.seconds) + " s " + answer.result.message);
  if (!is_success(answer.result.outcome())) {
    const std::vector<PartId> parts = state_.parts_of(ids);
    refused_.insert({parts, direction});
    for (const PartId id : parts)
      state_.set_failure(
          {id, answer.result.outcome(), answer.result.blocked_by, {}, answer.result.message, answer.certificate});
    return false;
  }
  state_.commit(group, ids, attempt, answer, GroupChange::Kind::removed);
  state_.count(ids.size() == 1 ? "straight" : "groups");
  return true;
}

}  // namespace dismantle::blocking
