// Several parts that move at once, each in its own way, until one of them is out: what an interlock asks for.
#include <algorithm>
#include <cmath>
#include <string>

#include "blocking/taking_apart.h"

namespace dismantle::blocking {
namespace {

constexpr std::size_t kMostAtOnce = 3;   // parts
constexpr std::size_t kCandidates = 12;  // sets that are moved a little, for one group as it stands
constexpr std::size_t kSearched = 2;     // ... and of those in which several parts moved, so many are searched for more
constexpr unsigned kDepths[] = {1, 1, 4};  // of the rounds: pairs, all, all that moved
constexpr unsigned kRounds = 3;
constexpr double kMoved = 0.1;  // assembly units; less is play

/// How far the part has come from where it was, turns included, as seen on its box.
double way_of(const Mesh& mesh, const Pose& from, const Pose& to) {
  const Aabb box = mesh.box();
  return box.empty() ? (to.t - from.t).norm() : screw_travel(from, to, box.center(), 0.5 * box.size().norm());
}

}  // namespace

/// Sets of units of which one would be free if it were not for the others of the set: the blocking graphs' edges where
/// they are fewest. Small sets first, then those with most directions in which it is so. The housing stays where it is.
std::vector<std::vector<TakingApart::UnitId>> TakingApart::interlocked(const Group& group) {
  const auto& base = oracle_.constraints().base;
  const UnitId housing = housing_of(group);
  const auto moves = [&](UnitId u) {
    return u != housing && units_[u].size() == 1 &&
           std::find(base.begin(), base.end(), units_[u].front()) == base.end();
  };
  std::vector<std::vector<UnitId>> sets;
  std::map<std::vector<UnitId>, std::size_t> ways;
  for (const UnitId u : group.units) {
    if (!moves(u) || !may_leave(group, {u})) continue;
    for (const std::size_t d : directions_.common) {
      std::vector<UnitId> set = in_way_of(group, u, d);
      if (stop()) return {};
      if (set.empty() || set.size() + 1 > kMostAtOnce || !std::all_of(set.begin(), set.end(), moves)) continue;
      set.push_back(u);
      std::sort(set.begin(), set.end());
      if (++ways[set] == 1) sets.push_back(std::move(set));
    }
  }
  std::stable_sort(sets.begin(), sets.end(), [&](const auto& a, const auto& b) {
    return a.size() != b.size() ? a.size() < b.size() : ways[a] > ways[b];
  });
  if (sets.size() > kCandidates) sets.resize(kCandidates);
  return sets;
}

/// Nothing when none of them may leave.
std::optional<Attempt> TakingApart::question_at_once(const Group& group, const std::vector<UnitId>& units) const {
  Attempt attempt = question(group, units);
  for (const UnitId u : units)
    if (may_leave(group, {u})) attempt.leaving.push_back(units_[u].front());
  if (attempt.leaving.empty()) return std::nullopt;
  attempt.max_depth = std::min(kDepths[group.at_once - 1], params_.max_depth);
  return attempt;
}

/// As for searches of single parts: not again while those that were touched are there. Deeper only where several moved.
bool TakingApart::worth_moving(const Group& group, const std::vector<UnitId>& units) const {
  const auto known = tried_at_once_.find(units);
  if (known == tried_at_once_.end()) return true;
  const Tried& last = known->second;
  if (std::any_of(last.blocked_by.begin(), last.blocked_by.end(),
                  [&](PartId b) { return !in_group(group, unit_of_[b]); }))
    return true;
  return last.outcome == Outcome::depth_limit && last.depth < kDepths[group.at_once - 1] &&
         moved_at_once_.contains(units);
}

bool TakingApart::together(Group& group, const std::vector<UnitId>& units,
                           const std::vector<std::vector<UnitId>>& next) {
  const std::optional<Attempt> asked = question_at_once(group, units);
  if (!asked) return false;
  const std::string& name = assembly_.parts[asked->moving.front().part].name;
  context_.progress("sequence", out_, units_.size() - 1, name);
  if (context_.threads > 1) {
    std::vector<Attempt> ahead{*asked};
    for (std::size_t k = 0; k < next.size() && k < kAheadPerThread * context_.threads; ++k)
      if (auto attempt = question_at_once(group, next[k])) ahead.push_back(std::move(*attempt));
    oracle_.prefetch(ahead, context_);
  }
  const AttemptResult& answer = oracle_.attempt(*asked, context_);
  const PathResult& result = answer.result;
  const std::uint64_t steps = result.stats.steps;
  std::string names;
  for (const UnitId u : units) names += (names.empty() ? "'" : "', '") + assembly_.parts[units_[u].front()].name;
  context_.log(LogLevel::debug, "moving " + names + "' at once to depth " + std::to_string(asked->max_depth) + ": " +
                                    std::string(to_string(result.outcome())) + ", " + std::to_string(answer.seconds) +
                                    " s, " + std::to_string(steps) + " steps " + result.message);
  if (is_success(result.outcome())) {
    const unsigned reached = group.depth;
    book(group, units, *asked, answer);
    group.depth = reached;
    ++counts_["at_once"];
    return true;
  }
  none_at_once_ = none_at_once_ || result.outcome() == Outcome::unsupported;
  tried_at_once_[units] = {asked->max_depth, result.outcome(), result.blocked_by, group.units.size()};
  std::size_t moved = 0;
  for (std::size_t i = 0; i < result.best_pose.size(); ++i) {
    const PlacedPart& p = asked->moving[i];
    if (way_of(*assembly_.parts[p.part].mesh, p.pose, result.best_pose[i]) > kMoved) ++moved;
  }
  if (moved > 1)
    moved_at_once_.insert(units);
  else
    moved_at_once_.erase(units);
  return false;
}

/// Three rounds. Pairs a little, before single parts are searched deeper; after that larger sets, which are dear; then
/// those in which more than one part moved deeper.
bool TakingApart::together(Group& group) {
  const unsigned rounds = group.searched_out || group.depth > 2 ? kRounds : group.depth - 1;
  if (none_at_once_ || group.at_once >= rounds) return false;
  const std::vector<std::vector<UnitId>> sets = interlocked(group);
  while (group.at_once < rounds) {
    ++group.at_once;
    std::vector<std::vector<UnitId>> list;
    for (const auto& set : sets)
      if (worth_moving(group, set) && (group.at_once > 1 || set.size() == 2) &&
          (group.at_once < kRounds || list.size() < kSearched))
        list.push_back(set);
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (stop() || none_at_once_) return false;
      if (together(group, list[k], {list.begin() + static_cast<std::ptrdiff_t>(k) + 1, list.end()})) return true;
    }
  }
  if (!sets.empty())
    group.at_once_said =
        std::to_string(sets.size()) + " sets of parts were moved at once, each part in its own way, in vain";
  return false;
}

}  // namespace dismantle::blocking
