// Straight ways out, by the blocking relations.
#include <algorithm>
#include <limits>

#include "blocking/graph.h"
#include "blocking/taking_apart.h"

namespace dismantle::blocking {
namespace {

constexpr std::size_t kWave = 4;       // directions of one part that are looked at together, nearest way out first
constexpr std::size_t kHints = 12;     // directions about which other threads are told ahead
constexpr double kBeyond = 1e-3;       // assembly units: how far past the last part a way leads at most
constexpr int kHalvings = 12;          // of the way, to find where the hulls come apart
constexpr double kClear = 0.01;        // assembly units: further than that, so that rounding when written does no harm
constexpr std::size_t kProposals = 8;  // groups that are put to the judge before something else is tried

}  // namespace

/// Questions about parts that together say whether `moving` can pass `still`.
std::vector<Pair> TakingApart::pairs_of(UnitId moving, UnitId still, std::size_t direction) const {
  std::vector<Pair> pairs;
  for (const PartId a : units_[moving])
    for (const PartId b : units_[still]) {
      const Pair pair{a, b, direction, poses_[a].t - poses_[b].t, turn_[a], turn_[b]};
      if (!relations_->far(pair)) pairs.push_back(pair);
    }
  return pairs;
}

/// All that `unit` would run into.
std::vector<TakingApart::UnitId> TakingApart::in_way_of(const Group& group, UnitId unit, std::size_t direction) {
  std::vector<Pair> pairs;
  for (const UnitId other : group.units)
    if (other != unit)
      for (const Pair& pair : pairs_of(unit, other, direction)) pairs.push_back(pair);
  relations_->compute(pairs);
  std::vector<UnitId> in_way;
  for (const Pair& pair : pairs)
    if (relations_->blocks(pair) && (in_way.empty() || in_way.back() != unit_of_[pair.still]))
      in_way.push_back(unit_of_[pair.still]);
  return in_way;
}

double TakingApart::way_out(const Group& group, const std::vector<UnitId>& units, std::size_t direction) const {
  const Eigen::Vector3d& d = directions_.all[direction];
  double ours = std::numeric_limits<double>::infinity(), theirs = -ours;
  for (const UnitId u : group.units) {
    const bool leaves = std::find(units.begin(), units.end(), u) != units.end();
    for (const PartId id : units_[u]) {
      const auto [lo, hi] = relations_->extent(id, direction, turn_[id]);
      const double shift = poses_[id].t.dot(d);
      if (leaves)
        ours = std::min(ours, lo + shift);
      else
        theirs = std::max(theirs, hi + shift);
    }
  }
  return std::max(0.0, theirs - ours);
}

std::vector<std::size_t> TakingApart::directions_of(UnitId unit) const {
  std::vector<std::size_t> list;
  for (const PartId id : units_[unit]) {
    const auto& of_part = directions_.of_part[id];
    list.insert(list.end(), of_part.begin(), of_part.end());
  }
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

/// Shortest way out first.
std::vector<std::size_t> TakingApart::directions_of(const Group& group, UnitId unit) const {
  std::vector<std::size_t> list = directions_of(unit);
  std::vector<std::pair<double, std::size_t>> ways;
  for (const std::size_t d : list) ways.emplace_back(way_out(group, {unit}, d), d);
  std::stable_sort(ways.begin(), ways.end(), [](const auto& a, const auto& b) { return a.first < b.first - 1e-9; });
  list.clear();
  for (const auto& [way, d] : ways) list.push_back(d);
  return list;
}

/// Pairs that have to be known to decide whether `unit` is free along `direction`, the likeliest to be in the way
/// first. None: it is decided; then watched_ names one that is in the way, or nobody.
std::vector<Pair> TakingApart::open_questions(const Group& group, UnitId unit, std::size_t direction) {
  const auto watched = watched_[unit].find(direction);
  if (watched != watched_[unit].end()) {
    if (in_group(group, watched->second)) return {};  // as long as that one is there
    watched_[unit].erase(watched);
  }
  const auto [in_way, pairs] = unknown_pairs(group, unit, direction);
  if (in_way) watched_[unit][direction] = *in_way;
  return pairs;
}

/// Who is known to be in the way; else what is not known.
std::pair<std::optional<TakingApart::UnitId>, std::vector<Pair>> TakingApart::unknown_pairs(
    const Group& group, UnitId unit, std::size_t direction) const {
  std::vector<std::pair<double, Pair>> unknown;  // by gap: the nearest is the likeliest
  for (const UnitId other : group.units) {
    if (other == unit) continue;
    for (const Pair& pair : pairs_of(unit, other, direction)) {
      if (relations_->known(pair)) {
        if (!relations_->blocks(pair)) continue;
        return {other, {}};
      }
      unknown.emplace_back(relations_->extent(pair.still, direction, pair.turn_still).first -
                               relations_->extent(pair.moving, direction, pair.turn_moving).second -
                               pair.offset.dot(directions_.all[direction]),
                           pair);
    }
  }
  std::stable_sort(unknown.begin(), unknown.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Pair> pairs;
  for (const auto& [gap, pair] : unknown) pairs.push_back(pair);
  return {std::nullopt, std::move(pairs)};
}

/// Decides the directions of `unit` wave by wave, until it has a free one. `next`: units whose turn it probably is
/// then.
void TakingApart::resolve(const Group& group, UnitId unit, std::span<const UnitId> next) {
  const std::vector<std::size_t> directions = directions_of(group, unit);
  for (std::size_t first = 0; first < directions.size() && !stop();) {
    const std::size_t last = std::min(first + kWave, directions.size());
    std::vector<Pair> questions;
    bool free = false;
    for (std::size_t k = first; k < last; ++k) {
      if (const auto open = open_questions(group, unit, directions[k]); !open.empty())
        questions.push_back(open.front());
      else
        free = free || !watched_[unit].contains(directions[k]);
    }
    if (!questions.empty()) {
      if (relations_->wants_hints()) hint(group, std::span(directions).subspan(first), unit, next);
      relations_->compute(questions);
    } else {
      if (free) return;
      first = last;
    }
  }
}

/// What will probably be asked: about `unit` in these directions, then about the first that are open of those after it.
void TakingApart::hint(const Group& group, std::span<const std::size_t> directions, UnitId unit,
                       std::span<const UnitId> next) {
  std::vector<std::vector<Pair>> lists;
  const auto add = [&](UnitId u, std::size_t direction) {
    auto list = open_questions(group, u, direction);
    if (list.empty()) return false;
    lists.push_back(std::move(list));
    return true;
  };
  for (const std::size_t d : directions)
    if (lists.size() < kHints) add(unit, d);
  for (const UnitId u : next) {
    if (lists.size() >= kHints) break;
    std::size_t open = 0;
    for (const std::size_t d : directions_of(group, u)) {
      if (open == kWave || lists.size() >= kHints) break;
      if (add(u, d))
        ++open;
      else if (!watched_[u].contains(d))
        break;  // free
    }
  }
  relations_->hint(lists);
}

/// What will be asked when `units` are out: along which directions they were in somebody's way, and what was not asked
/// before.
void TakingApart::hint_if_out(const Group& group, const std::vector<UnitId>& units) const {
  Group left = group;
  std::erase_if(left.units, [&](UnitId u) { return std::find(units.begin(), units.end(), u) != units.end(); });
  std::vector<std::vector<Pair>> lists;
  for (const UnitId u : left.units) {
    const auto blocked = [&](std::size_t d) {
      const auto watched = watched_[u].find(d);
      return watched != watched_[u].end() && in_group(left, watched->second);
    };
    const std::vector<std::size_t> own = directions_of(u);
    if (std::all_of(own.begin(), own.end(), blocked) || !may_leave(left, {u})) continue;
    std::size_t open = 0;
    for (const std::size_t d : directions_of(left, u)) {
      if (open == kWave || lists.size() == kHints) break;
      if (blocked(d)) continue;
      auto [in_way, pairs] = unknown_pairs(left, u, d);
      if (in_way) continue;
      if (pairs.empty()) break;  // free
      lists.push_back(std::move(pairs));
      ++open;
    }
    if (lists.size() == kHints) break;
  }
  relations_->hint(lists);
}

/// The shortest way out among the first wave of directions that has a free one.
std::optional<std::size_t> TakingApart::free_direction(const Group& group, UnitId unit, std::span<const UnitId> next) {
  resolve(group, unit, next);
  if (stop()) return std::nullopt;
  for (const std::size_t d : directions_of(group, unit)) {
    if (watched_[unit].contains(d) || refused_.contains({units_[unit], d})) continue;
    if (!open_questions(group, unit, d).empty())
      continue;  // not looked at: a nearer wave had a free one, which was refused
    if (!watched_[unit].contains(d)) return d;
  }
  return std::nullopt;
}

/// Puts a straight way out to the judge, as short as the test of hulls allows; books it if it holds.
bool TakingApart::leave(Group& group, const std::vector<UnitId>& units, std::size_t direction) {
  const Attempt attempt = question(group, units);
  const Eigen::Vector3d& d = directions_.all[direction];
  const double out = oracle_.judge()->way_apart(attempt.moving, attempt.still, d,
                                                way_out(group, units, direction) + kBeyond, kHalvings) +
                     kClear;
  Path way(2);
  for (const auto& p : attempt.moving) {
    way[0].push_back(p.pose);
    way[1].push_back({p.pose.t + out * d, p.pose.q});
  }
  context_.progress("sequence", out_, units_.size() - 1, assembly_.parts[attempt.moving.front().part].name);
  if (relations_->works_ahead()) hint_if_out(group, units);
  const AttemptResult& answer = oracle_.propose(attempt, way, context_);
  context_.log(LogLevel::debug, "straight way of '" + assembly_.parts[attempt.moving.front().part].name + "' and " +
                                    std::to_string(attempt.moving.size() - 1) +
                                    " more: " + std::string(to_string(answer.result.outcome)) + ", " +
                                    std::to_string(answer.seconds) + " s " + answer.result.message);
  if (!is_success(answer.result.outcome)) {
    refused_.insert({parts_of(units), direction});
    for (const PartId id : parts_of(units))
      said_[id] = Unsolved{id, answer.result.outcome, answer.result.blocked_by, {}, answer.result.message,
                           answer.certificate};
    return false;
  }
  book(group, units, attempt, answer);
  ++counts_[units.size() == 1 ? "straight" : "groups"];
  return true;
}

bool TakingApart::remove_free_unit(Group& group) {
  const std::vector<UnitId> units = group.units;
  for (std::size_t k = 0; k < units.size() && !stop(); ++k) {
    if (!may_leave(group, {units[k]})) continue;
    while (const auto d = free_direction(group, units[k], std::span(units).subspan(k + 1)))
      if (leave(group, {units[k]}, *d)) return true;
  }
  return false;
}

/// One step towards the target: itself if it is free, else a free one among those in its way, and in theirs.
bool TakingApart::remove_for_target(Group& group) {
  std::vector<UnitId> wanted{unit_of_[*oracle_.constraints().target]};
  for (std::size_t k = 0; k < wanted.size() && !stop(); ++k) {
    const UnitId unit = wanted[k];
    if (may_leave(group, {unit}))
      while (const auto d = free_direction(group, unit))
        if (leave(group, {unit}, *d)) return true;
    // Along which direction is least in the way?
    std::vector<UnitId> fewest;
    bool found = false;
    for (const std::size_t d : directions_of(group, unit)) {
      const std::vector<UnitId> in_way = in_way_of(group, unit, d);
      if (!found || in_way.size() < fewest.size()) fewest = in_way;
      found = true;
    }
    for (const UnitId other : fewest)
      if (std::find(wanted.begin(), wanted.end(), other) == wanted.end()) wanted.push_back(other);
  }
  return false;
}

/// No single part is free: takes out the smallest group that is.
bool TakingApart::split(Group& group) {
  struct Candidate {
    std::vector<UnitId> units;
    std::size_t parts, direction;
  };
  std::vector<Candidate> candidates;
  const std::size_t n = group.units.size();
  for (const std::size_t d : directions_.common) {
    if (stop()) return false;
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (i != j)
          for (const Pair& pair : pairs_of(group.units[i], group.units[j], d)) pairs.push_back(pair);
    relations_->compute(pairs);
    std::vector<std::vector<std::size_t>> in_way(n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        if (i == j) continue;
        const auto between = pairs_of(group.units[i], group.units[j], d);
        if (std::any_of(between.begin(), between.end(), [&](const Pair& p) { return relations_->blocks(p); }))
          in_way[i].push_back(j);
      }
    for (const auto& members : free_groups(in_way)) {
      Candidate c{{}, 0, d};
      for (const std::size_t i : members) c.units.push_back(group.units[i]);
      c.parts = parts_of(c.units).size();
      Candidate rest{{}, 0, Directions::opposite(d)};  // what is left moves the other way just as well
      for (const UnitId u : group.units)
        if (std::find(c.units.begin(), c.units.end(), u) == c.units.end()) rest.units.push_back(u);
      rest.parts = parts_of(rest.units).size();
      const bool first = c.parts <= rest.parts;
      for (const Candidate& candidate : {first ? c : rest, first ? rest : c})
        if (may_leave(group, candidate.units)) {
          candidates.push_back(candidate);
          break;
        }
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.parts < b.parts; });
  std::size_t tried = 0;
  for (const Candidate& c : candidates) {
    if (stop() || tried == kProposals) return false;
    if (refused_.contains({parts_of(c.units), c.direction})) continue;
    ++tried;
    if (leave(group, c.units, c.direction)) return true;
  }
  return false;
}

}  // namespace dismantle::blocking
