#include "dismantle/plan_io/plan_history.h"

#include <algorithm>
#include <set>

#include "dismantle/errors.h"

namespace dismantle {
namespace {

using PartList = std::vector<std::size_t>;

/// Index in `pieces` of the piece that stays if the step names all parts of a group.
std::size_t staying_piece(const std::vector<PartList>& pieces, const std::set<std::size_t>& movers) {
  const auto key = [&](const PartList& piece) {
    const bool fixed = std::ranges::none_of(piece, [&](std::size_t i) { return movers.contains(i); });
    return std::pair(fixed, piece.size());
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < pieces.size(); ++i)
    if (key(pieces[i]) > key(pieces[best])) best = i;
  return best;
}

/// The value after `done` steps of a list of changes in order; `initial` before the first.
template <class Value>
Value value_after(const std::vector<std::pair<std::size_t, Value>>& changes, std::size_t done, const Value& initial) {
  const auto later = std::ranges::upper_bound(changes, done, {}, &std::pair<std::size_t, Value>::first);
  return later == changes.begin() ? initial : std::prev(later)->second;
}

}  // namespace

PlanHistory::PlanHistory(const Plan& plan)
    : group_(plan.assembly.parts.size()), pose_(group_.size()), rank_(group_.size()), out_in_(group_.size()) {
  std::vector<PartList> now(1);  // by group; ascending
  for (std::size_t i = 0; i < parts(); ++i) {
    index_.emplace(plan.assembly.parts[i].name, i);
    now[0].push_back(i);
  }
  groups_.emplace_back();
  for (std::size_t s = 0; s < plan.disassembly.size(); ++s) {
    const PlanStep& step = plan.disassembly[s];
    split(step, s, now);
    for (const PlanMove& move : step.moves)
      if (!move.poses.empty()) pose_[index_of(move.part)].emplace_back(s + 1, move.poses.back());
  }
  for (std::size_t g = 0; g < groups(); ++g) {
    Group& group = groups_[g];
    group.parts.insert(group.parts.end(), now[g].begin(), now[g].end());
    group.until.resize(group.parts.size(), kStays);
    std::ranges::reverse(group.parts);
    std::ranges::reverse(group.until);
  }
  find_out(plan);
}

void PlanHistory::split(const PlanStep& plan_step, std::size_t step, std::vector<PartList>& now) {
  std::set<std::size_t> movers, named;
  for (const PlanMove& move : plan_step.moves) movers.insert(index_of(move.part));
  std::map<std::size_t, std::vector<PartList>> pieces_of;  // by the group that they are taken from
  for (const auto& names : plan_step.separates) {
    std::map<std::size_t, PartList> by_group;
    for (const std::string& name : names)
      if (const std::size_t i = index_of(name); named.insert(i).second) by_group[group_of(i, step)].push_back(i);
    for (auto& [group, piece] : by_group) {
      std::ranges::sort(piece);
      pieces_of[group].push_back(std::move(piece));
    }
  }
  auto& splits = splits_.emplace_back();
  for (auto& [from, pieces] : pieces_of) {
    std::size_t taken = 0;
    for (const PartList& piece : pieces) taken += piece.size();
    if (taken == now[from].size())
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(staying_piece(pieces, movers)));
    if (pieces.empty()) continue;
    GroupSplit& out = splits.emplace_back(GroupSplit{from, {}});
    for (PartList& piece : pieces) {
      out.out.push_back(groups());
      for (const std::size_t i : piece) {
        group_[i].emplace_back(step + 1, groups());
        if (!rank_[i]) rank_[i] = leavers_++;
        groups_[from].parts.push_back(i);
        groups_[from].until.push_back(step);
      }
      std::erase_if(now[from], [&](std::size_t i) { return std::ranges::binary_search(piece, i); });
      groups_.push_back({step + 1, {}, {}});
      now.push_back(std::move(piece));
    }
  }
}

void PlanHistory::find_out(const Plan& plan) {
  std::set<std::size_t> remaining;
  for (const std::string& name : plan.remaining) remaining.insert(index_of(name));
  for (std::size_t g = 1; g < groups(); ++g) {
    const auto last = members(g, steps());
    if (last.size() > 1 && std::ranges::any_of(last, [&](std::size_t i) { return remaining.contains(i); })) continue;
    std::size_t step = groups_[g].since - 1;  // in which it became what it is at the end
    if (last.size() < groups_[g].parts.size()) step = groups_[g].until[last.size()];
    for (const std::size_t i : last) out_in_[i] = step;
  }
}

std::size_t PlanHistory::index_of(const std::string& part) const {
  const auto it = index_.find(part);
  if (it == index_.end()) throw InputError(part, "the plan names a part that its assembly does not have");
  return it->second;
}

std::vector<std::size_t> PlanHistory::leaving(std::size_t step) const {
  std::vector<std::size_t> out;
  for (const GroupSplit& split : splits(step))
    for (const std::size_t group : split.out) {
      const auto parts = members(group, step + 1);
      out.insert(out.end(), parts.begin(), parts.end());
    }
  std::ranges::sort(out);
  return out;
}

std::size_t PlanHistory::group_of(std::size_t part, std::size_t done) const {
  return value_after(group_.at(part), done, std::size_t{0});
}

std::span<const std::size_t> PlanHistory::members(std::size_t group, std::size_t done) const {
  const Group& all = groups_.at(group);
  if (done < all.since) return {};
  const auto left = std::ranges::partition_point(all.until, [&](std::size_t step) { return step >= done; });
  return std::span(all.parts).first(static_cast<std::size_t>(left - all.until.begin()));
}

Pose PlanHistory::pose_of(std::size_t part, std::size_t done) const {
  return value_after(pose_.at(part), done, Pose{});
}

}  // namespace dismantle
