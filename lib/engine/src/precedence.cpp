#include "precedence.h"

#include <algorithm>
#include <map>

namespace dismantle {

namespace {

bool holds(const std::vector<PartId>& parts, PartId id) {
  return std::find(parts.begin(), parts.end(), id) != parts.end();
}

/// Who hung together with whom, and where, just before each step.
struct Before {
  std::vector<Pose> poses;          // by part
  std::vector<std::size_t> groups;  // by part
};

std::vector<Before> befores(const std::vector<RecordedStep>& steps, std::size_t part_count) {
  std::vector<Before> list{{std::vector<Pose>(part_count), std::vector<std::size_t>(part_count, 0)}};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    Before next = list.back();
    for (std::size_t k = 0; k < steps[i].parts.size(); ++k) {
      next.poses[steps[i].parts[k]] = steps[i].path->back()[k];
      if (steps[i].leaves(steps[i].parts[k])) next.groups[steps[i].parts[k]] = i + 1;
    }
    list.push_back(std::move(next));
  }
  return list;
}

/// Without turns, along one line.
bool is_straight(const std::vector<Pose>& way) {
  const Eigen::Vector3d along = way.back().t - way.front().t;
  for (const Pose& p : way) {
    if (angle_between(p.q, way.front().q) > 0) return false;
    if (along.cross(p.t - way.front().t).norm() > 1e-9 * along.norm()) return false;
  }
  return true;
}

bool needs(const RecordedStep& b, const RecordedStep& a, const Before& before, const Verifier& verifier) {
  for (const PartId id : b.parts)
    if (holds(a.parts, id)) return true;
  // Parted before that: nothing that a did was in b's way.
  if (before.groups[b.parts.front()] != a.from) return false;
  for (std::size_t k = 0; k < b.parts.size(); ++k) {
    std::vector<Pose> way;
    for (const auto& instant : *b.path) way.push_back(instant[k]);
    if (way.size() > 2 && is_straight(way)) way = {way.front(), way.back()};
    for (const PartId id : a.parts)
      if (!verifier.passes(b.parts[k], id, before.poses[id], way)) return true;
  }
  return false;
}

}  // namespace

std::vector<std::vector<std::size_t>> needed_steps(const std::vector<RecordedStep>& steps, std::size_t part_count,
                                                   const Verifier& verifier, const RunContext& context) {
  const std::vector<Before> before = befores(steps, part_count);
  const std::size_t n = steps.size();
  std::vector<std::vector<std::size_t>> needed(n);
  std::vector<std::vector<bool>> follows(n, std::vector<bool>(n, false));  // [b][a]: a has to come before b
  for (std::size_t b = 0; b < n; ++b) {
    // Latest first: what follows from a later one is not asked for.
    for (std::size_t a = b; a-- > 0;) {
      if (follows[b][a]) continue;
      if (!context.should_stop() && !needs(steps[b], steps[a], before[a], verifier)) continue;
      needed[b].push_back(a);
      follows[b][a] = true;
      for (std::size_t c = 0; c < a; ++c) follows[b][c] = follows[b][c] || follows[a][c];
    }
    std::reverse(needed[b].begin(), needed[b].end());
  }
  return needed;
}

std::vector<unsigned> layers_of(const std::vector<std::vector<std::size_t>>& needed) {
  std::vector<unsigned> layers(needed.size(), 1);
  for (std::size_t b = 0; b < needed.size(); ++b)
    for (const std::size_t a : needed[b]) layers[b] = std::max(layers[b], layers[a] + 1);
  return layers;
}

std::vector<std::pair<PartId, PartId>> part_precedence(const std::vector<RecordedStep>& steps,
                                                       const std::vector<std::vector<std::size_t>>& needed) {
  // A part leaves with its last removal; shifts before that are part of it.
  std::map<PartId, std::size_t> leaves;
  for (std::size_t i = 0; i < steps.size(); ++i)
    for (const PartId id : steps[i].parts)
      if (steps[i].leaves(id)) leaves[id] = i;
  std::vector<std::pair<PartId, PartId>> pairs;
  for (std::size_t b = 0; b < steps.size(); ++b)
    for (const std::size_t a : needed[b])
      for (const PartId before : steps[a].parts)
        for (const PartId after : steps[b].parts) {
          const auto first = leaves.find(before), second = leaves.find(after);
          if (first == leaves.end() || second == leaves.end() || first->second >= second->second) continue;
          const std::pair pair{before, after};
          if (std::find(pairs.begin(), pairs.end(), pair) == pairs.end()) pairs.push_back(pair);
        }
  return pairs;
}

}  // namespace dismantle
