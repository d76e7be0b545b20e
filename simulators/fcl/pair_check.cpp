#include <algorithm>
#include <limits>

#include "world.h"

namespace dismantle::mesh_collision {
Aabb moved_box(const Aabb& box, const Pose& pose) {
  const Eigen::Matrix3d r = pose.q.toRotationMatrix();
  const Eigen::Vector3d center = r * box.center() + pose.t, half = r.cwiseAbs() * (0.5 * box.size());
  return {center - half, center + half};
}

/// For surfaces that do not meet: is a shell of `a` inside the material of `b`? Stores a corner of each in corners_.
bool PairCheck::contained(const Body& a, const Pose& a_to_b, const Body& b) {
  corners_.clear();
  for (const auto v : a.graph.shell_vertex) {
    const Eigen::Vector3d p = a_to_b * a.mesh.vertices[v];
    if (b.box.contains(p) && signed_distance(b.solids, p) < 0) corners_.push_back(v);
  }
  return !corners_.empty();
}

bool PairCheck::collide(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b) {
  if (collider_.meet(a.surface, pose_a, b.surface, pose_b)) return true;
  const Pose a_to_b = pose_b.inverse() * pose_a;
  // A body can be inside another one only if their boxes overlap, which is a cheap test in the other's frame.
  const Aabb a_in_b = moved_box(a.box, a_to_b);
  if (a_in_b.overlaps(b.box) && contained(a, a_to_b, b)) return true;
  const Pose b_to_a = a_to_b.inverse();
  return moved_box(b.box, b_to_a).overlaps(a.box) && contained(b, b_to_a, a);
}

double PairCheck::measure(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b, double enough) {
  const Pose a_to_b = pose_b.inverse() * pose_a, b_to_a = a_to_b.inverse();
  double deepest = 0;
  // The first triangle pairs usually suffice to find that a state is too deep. States that need a measurement have
  // fewer pairs than the second limit.
  for (const std::size_t limit : {std::size_t{16}, std::size_t{1} << 20}) {
    collider_.pairs(a.surface, pose_a, b.surface, pose_b, limit, pairs_);
    if (pairs_.empty()) break;
    const DepthGauge::Effort effort{parameters_.resolution, enough, pairs_.size() < limit};
    const double of_a = gauge_.deepest(a, b, a_to_b, pairs_, false, effort);
    const double of_b = of_a < enough ? gauge_.deepest(b, a, b_to_a, pairs_, true, effort) : 0.0;
    deepest = std::max(of_a, of_b);
    if (deepest >= enough) return deepest;
    // Single shells that meet cannot contain each other.
    if (effort.thorough && a.graph.shell_vertex.size() == 1 && b.graph.shell_vertex.size() == 1) return deepest;
    if (effort.thorough) break;
  }
  const DepthGauge::Effort effort{parameters_.resolution, enough, true};
  if (contained(a, a_to_b, b)) deepest = std::max(deepest, gauge_.deepest(a, b, a_to_b, corners_, effort));
  if (contained(b, b_to_a, a)) deepest = std::max(deepest, gauge_.deepest(b, a, b_to_a, corners_, effort));
  return deepest;
}

/// If the shrunken copy of a does not meet the surface of b, each of its shells is entirely inside or outside b. If all
/// are outside, each surface point of a is within `depth` of a point outside b, so it is no deeper.
bool PairCheck::inset_is_clear(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b, double depth) {
  const auto found = a.insets.find(depth);
  if (found == a.insets.end()) return false;
  if (collider_.meet(found->second.surface, pose_a, b.surface, pose_b)) return false;
  const Pose a_to_b = pose_b.inverse() * pose_a;
  return std::all_of(found->second.shell_points.begin(), found->second.shell_points.end(), [&](const auto& v) {
    const Eigen::Vector3d p = a_to_b * v;
    return !b.box.contains(p) || signed_distance(b.solids, p) > 0;
  });
}

bool PairCheck::certify(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b, double depth) {
  return inset_is_clear(a, pose_a, b, pose_b, depth) && inset_is_clear(b, pose_b, a, pose_a, depth);
}

double PairCheck::depth(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b, double allowed) {
  if (!collide(a, pose_a, b, pose_b)) return 0;
  const double certified = parameters_.certified_depth;
  if (certified > 0 && certify(a, pose_a, b, pose_b, allowed + certified)) return certified;
  const double measured = measure(a, pose_a, b, pose_b, allowed + parameters_.depth_limit) - allowed;
  // The search has stopped, so return an upper bound: a ball inside a part has at most half its box's diagonal as
  // radius.
  if (measured >= parameters_.depth_limit)
    return std::max(measured, 0.5 * std::min(a.box.size().norm(), b.box.size().norm()) - allowed);
  return std::max(0.0, measured);
}

}  // namespace dismantle::mesh_collision
