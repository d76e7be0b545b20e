#include "dismantle/disassembly.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "dismantle/part_set.h"

namespace dismantle {

std::vector<PartId> DisassemblyStep::leaving() const {
  if (placement) return {};
  return released ? std::vector<PartId>{*released} : parts;
}

Disassembly::Disassembly(std::size_t parts) : stands_(parts), groups_(1) {
  for (PartId id = 0; id < parts; ++id) {
    stands_[id].push_back({0, Pose{}, 0});
    groups_[0].push_back(id);
  }
}

Disassembly::Disassembly(std::size_t parts, const std::vector<std::vector<PlacedPart>>& groups)
    : start_groups_(groups.size()), stands_(parts), groups_(groups.size()) {
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const PlacedPart& p : groups[g]) {
      if (p.part >= parts || !stands_[p.part].empty())
        throw std::invalid_argument("a part of the start is unknown or listed twice");
      stands_[p.part].push_back({0, p.pose, g});
      groups_[g].push_back(p.part);
    }
    std::sort(groups_[g].begin(), groups_[g].end());
  }
  for (auto& stands : stands_)
    if (stands.empty()) stands.push_back({0, Pose{}, kAbsent});
}

const Disassembly::Stand& Disassembly::stand(PartId part, std::size_t after) const {
  const std::vector<Stand>& list = stands_[part];
  if (after >= steps_.size()) return list.back();
  return *std::prev(std::partition_point(list.begin(), list.end(), [&](const Stand& s) { return s.since <= after; }));
}

std::optional<std::size_t> Disassembly::common_group(std::span<const PartId> parts) const {
  if (parts.empty() || parts.front() >= stands_.size()) return std::nullopt;
  const std::size_t common = group(parts.front());
  const auto is_in = [&](PartId id) { return id < stands_.size() && group(id) == common; };
  if (common == kAbsent || !std::all_of(parts.begin(), parts.end(), is_in)) return std::nullopt;
  return common;
}

void Disassembly::add(DisassemblyStep step) {
  const std::optional<std::size_t> from = common_group(step.parts);
  if (!from) throw std::logic_error("the parts of a step are unknown or not together any more");
  if (std::adjacent_find(step.parts.begin(), step.parts.end(), std::greater_equal<>()) != step.parts.end())
    throw std::logic_error("the parts of a step are not in ascending order");
  const std::vector<PartId> leaving = step.leaving();
  if (leaving.size() == groups_[*from].size()) throw std::logic_error("a removal that leaves nothing behind");
  const std::size_t made = group_of_step(steps_.size());
  groups_[*from] = without(groups_[*from], leaving);
  groups_.push_back(leaving);
  for (std::size_t i = 0; i < step.parts.size(); ++i) {
    const PartId id = step.parts[i];
    stands_[id].push_back({steps_.size() + 1, step.path->back()[i], step.leaves(id) ? made : *from});
  }
  steps_.push_back(std::move(step));
}

void Disassembly::pop() {
  const DisassemblyStep& last = steps_.back();
  for (const PartId id : last.parts) stands_[id].pop_back();
  std::vector<PartId>& from = groups_[stands_[last.parts.front()].back().group];
  from.insert(from.end(), groups_.back().begin(), groups_.back().end());
  std::sort(from.begin(), from.end());
  groups_.pop_back();
  steps_.pop_back();
}

void Disassembly::follow(const Disassembly& other) {
  std::size_t same = 0;  // a step and its copy share the path
  while (same < std::min(steps_.size(), other.steps_.size()) && steps_[same].path == other.steps_[same].path) ++same;
  while (steps_.size() > same) pop();
  for (std::size_t k = same; k < other.steps_.size(); ++k) add(other.steps_[k]);
}

std::vector<PlacedPart> Disassembly::placed(std::span<const PartId> parts, std::size_t after) const {
  std::vector<PlacedPart> list;
  for (const PartId id : parts) list.push_back({id, pose(id, after)});
  return list;
}

std::vector<PlacedPart> Disassembly::around(PartId part) const {
  if (group(part) == kAbsent) return {};
  return placed(without(groups_[group(part)], std::vector{part}));
}

std::vector<std::vector<PlacedPart>> open_groups(const Disassembly& disassembly, const Constraints& constraints) {
  std::vector<std::vector<PlacedPart>> open;
  for (const std::vector<PartId>& group : disassembly.groups()) {
    if (group.empty()) continue;
    const bool closed = kept_together(group, constraints);
    if (closed && constraints.target && contains(group, *constraints.target)) return {};
    if (!closed) open.push_back(disassembly.placed(group));
  }
  return open;
}

bool fulfilled(const Disassembly& disassembly, const Constraints& constraints) {
  return open_groups(disassembly, constraints).empty();
}

void set_units(Assembly& assembly, const Constraints& constraints) {
  const std::vector<PartId> sets = kept_sets(assembly.parts.size(), constraints);
  for (Part& part : assembly.parts)
    if (part.unit.reset(); std::count(sets.begin(), sets.end(), sets[part.id]) > 1) part.unit = sets[part.id];
}

std::vector<PartId> kept_sets(std::size_t parts, const Constraints& constraints) {
  std::vector<PartId> set(parts);
  std::iota(set.begin(), set.end(), PartId{0});
  for (const std::vector<PartId>& list : constraints.together)
    for (const PartId id : list) {
      const PartId from = set[id], to = set[list.front()];
      std::replace(set.begin(), set.end(), from, to);
    }
  return set;
}

bool kept_together(std::span<const PartId> group, const Constraints& constraints) {
  if (group.size() <= 1) return true;
  std::vector<PartId> reached{group.front()};
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (const std::vector<PartId>& list : constraints.together)
      if (contains(list, reached[k]))
        for (const PartId id : list)
          if (!contains(reached, id)) reached.push_back(id);
  return std::all_of(group.begin(), group.end(), [&](PartId id) { return contains(reached, id); });
}

bool may_leave(std::span<const PartId> leaving, std::span<const PartId> rest, const Constraints& constraints) {
  const auto leaves = [&](PartId id) { return contains(leaving, id); };
  if (std::any_of(constraints.base.begin(), constraints.base.end(), leaves)) return false;
  return std::none_of(constraints.before.begin(), constraints.before.end(), [&](const auto& rule) {
    return leaves(rule.second) && !leaves(rule.first) && contains(rest, rule.first);
  });
}

}  // namespace dismantle
