#include "precedence.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "dismantle/geometry/swept_boxes.h"
#include "dismantle/part_set.h"

namespace dismantle {

namespace {

/// True for a path without rotation, along one line.
bool is_straight(const std::vector<Pose>& poses) {
  const Eigen::Vector3d along = poses.back().t - poses.front().t;
  for (const Pose& p : poses) {
    if (angle_between(p.q, poses.front().q) > 0) return false;
    if (along.cross(p.t - poses.front().t).norm() > 1e-9 * along.norm()) return false;
  }
  return true;
}

/// The way of one part in a step, with the box around all of it.
struct PartMotion {
  std::vector<Pose> poses;
  Aabb box;
};

std::vector<PartMotion> motions_of(const DisassemblyStep& step, const std::vector<Aabb>& boxes) {
  std::vector<PartMotion> motions;
  for (std::size_t k = 0; k < step.parts.size(); ++k) {
    std::vector<Pose> poses;
    for (const auto& instant : *step.path) poses.push_back(instant[k]);
    if (poses.size() > 2 && is_straight(poses)) poses = {poses.front(), poses.back()};
    const Aabb around = geometry::SweptBoxes(poses, boxes[step.parts[k]]).whole();
    motions.push_back({std::move(poses), around});
  }
  return motions;
}

/// Asks the verifier only about pairs of parts whose boxes meet; most pairs of steps have none.
class Needs {
 public:
  Needs(const Disassembly& done, const Assembly& assembly, const Verifier& verifier)
      : done_(done), steps_(done.steps()), verifier_(verifier), moved_in_(assembly.parts.size()) {
    for (const Part& part : assembly.parts) boxes_.push_back(part.mesh->box());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      for (const PartId id : steps_[i].parts) moved_in_[id].push_back(i);
      std::vector<Aabb>& begin = begins_.emplace_back();
      Aabb& all = around_.emplace_back();
      for (const PartId id : steps_[i].parts) {
        begin.push_back(geometry::box_under(boxes_[id], done_.pose(id, i)));
        all.extend(begin.back());
      }
    }
  }

  /// The steps before b, latest first, that move a part of b, or parts that may be in the way of these motions. One
  /// pass over a list of boxes.
  std::vector<std::size_t> candidates(std::size_t b, const std::vector<PartMotion>& motions) const {
    Aabb swept;
    for (const PartMotion& m : motions) swept.extend(m.box);
    std::vector<std::size_t> found;
    for (std::size_t a = b; a-- > 0;)
      if (swept.overlaps(around_[a])) found.push_back(a);
    const std::size_t boxes = found.size();
    for (const PartId id : steps_[b].parts)
      for (const std::size_t a : moved_in_[id])
        if (a < b) found.push_back(a);
    if (found.size() > boxes) {
      std::sort(found.begin(), found.end(), std::greater<>());
      found.erase(std::unique(found.begin(), found.end()), found.end());
    }
    return found;
  }

  const std::vector<Aabb>& boxes() const { return boxes_; }

  /// Does step b, with these ways of its parts, need the earlier step a?
  bool operator()(std::size_t b, const std::vector<PartMotion>& motions, std::size_t a) const {
    const std::vector<PartId>&these = steps_[b].parts, &those = steps_[a].parts;
    for (const PartId id : these)
      if (contains(those, id)) return true;
    // In different groups before a: its parts were not in the way of b.
    if (done_.group(these.front(), a) != done_.left_group(a)) return false;
    for (std::size_t k = 0; k < these.size(); ++k)
      for (std::size_t j = 0; j < those.size(); ++j)
        if (motions[k].box.overlaps(begins_[a][j]) &&
            !verifier_.passes(these[k], those[j], done_.pose(those[j], a), motions[k].poses))
          return true;
    return false;
  }

 private:
  const Disassembly& done_;
  const std::vector<DisassemblyStep>& steps_;
  const Verifier& verifier_;
  std::vector<Aabb> boxes_;                         // by part, in its own frame
  std::vector<std::vector<Aabb>> begins_;           // [step][k]: of its k-th part, where it stands just before
  std::vector<Aabb> around_;                        // [step]: around these
  std::vector<std::vector<std::size_t>> moved_in_;  // by part: the steps that move it
};

}  // namespace

std::vector<std::vector<std::size_t>> needed_steps(const Disassembly& done, const Assembly& assembly,
                                                   const Verifier& verifier, const RunContext& context) {
  const Needs needs(done, assembly, verifier);
  const std::vector<DisassemblyStep>& steps = done.steps();
  const std::size_t n = steps.size();
  std::vector<std::vector<std::size_t>> needed(n);
  std::vector<std::vector<bool>> follows(n, std::vector<bool>(n, false));  // [b][a]: a has to come before b
  // Also after a time limit: it is cheap, and a wrong order is worse than a late end.
  for (std::size_t b = 0; b < n; ++b) {
    const std::vector<PartMotion> motions = motions_of(steps[b], needs.boxes());
    // Latest first: steps implied by a later one are not checked.
    for (const std::size_t a : needs.candidates(b, motions)) {
      if (context.cancel.cancelled()) {
        needed.resize(b);
        return needed;
      }
      if (follows[b][a] || !needs(b, motions, a)) continue;
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

std::vector<std::pair<PartId, PartId>> part_precedence(const Disassembly& done,
                                                       const std::vector<std::vector<std::size_t>>& needed) {
  const std::vector<DisassemblyStep>& steps = done.steps();
  // A part leaves with its last removal; intermediate placements before that are part of it.
  std::map<PartId, std::size_t> leaves;
  for (std::size_t i = 0; i < steps.size(); ++i)
    for (const PartId id : steps[i].parts)
      if (steps[i].leaves(id)) leaves[id] = i;
  std::vector<std::pair<PartId, PartId>> pairs;
  std::set<std::pair<PartId, PartId>> known;
  for (std::size_t b = 0; b < needed.size(); ++b)
    for (const std::size_t a : needed[b])
      for (const PartId before : steps[a].parts)
        for (const PartId after : steps[b].parts) {
          const auto first = leaves.find(before), second = leaves.find(after);
          if (first == leaves.end() || second == leaves.end() || first->second >= second->second) continue;
          const std::pair pair{before, after};
          if (known.insert(pair).second) pairs.push_back(pair);
        }
  return pairs;
}

}  // namespace dismantle
