#include <algorithm>
#include <limits>

#include "world.h"

namespace dismantle::mesh_collision {
namespace {

/// More pairs of triangles than any two parts have that meet in a state worth measuring.
constexpr std::size_t kMaxPairs = std::size_t{1} << 20;

void sort_unique(std::vector<std::uint32_t>& v) {
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

}  // namespace

Aabb moved_box(const Aabb& box, const Pose& pose) {
  const Eigen::Matrix3d r = pose.q.toRotationMatrix();
  const Eigen::Vector3d center = r * box.center() + pose.t, half = r.cwiseAbs() * (0.5 * box.size());
  return {center - half, center + half};
}

/// Their surfaces do not meet: a shell of one inside the material of the other?
bool PairCheck::contained(const Body& a, const Pose& a_to_b, const Body& b) const {
  for (const auto v : a.graph.shell_vertex) {
    const Eigen::Vector3d p = a_to_b * a.mesh.vertices[v];
    if (b.box.contains(p) && signed_distance(b.solids, p) < 0) return true;
  }
  return false;
}

bool PairCheck::collide(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b) {
  if (collider_.meet(a.surface, pose_a, b.surface, pose_b)) return true;
  const Pose a_to_b = pose_b.inverse() * pose_a;
  // Only a body whose box fits into the other's can be inside it; in the other's frame that is a cheap test.
  const Aabb a_in_b = moved_box(a.box, a_to_b);
  if (a_in_b.overlaps(b.box) && contained(a, a_to_b, b)) return true;
  const Pose b_to_a = a_to_b.inverse();
  return moved_box(b.box, b_to_a).overlaps(a.box) && contained(b, b_to_a, a);
}

double PairCheck::measure(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b, double enough) {
  const Pose a_to_b = pose_b.inverse() * pose_a, b_to_a = a_to_b.inverse();
  collider_.pairs(a.surface, pose_a, b.surface, pose_b, kMaxPairs, pairs_);
  if (pairs_.empty()) {
    double deepest = 0;
    if (contained(a, a_to_b, b)) deepest = gauge_.deepest(a, b, a_to_b, parameters_.resolution, enough);
    if (contained(b, b_to_a, a))
      deepest = std::max(deepest, gauge_.deepest(b, a, b_to_a, parameters_.resolution, enough));
    return deepest;
  }
  triangles_.clear();
  for (const auto& pair : pairs_) triangles_.push_back(pair.a);
  sort_unique(triangles_);
  const double of_a = gauge_.deepest(a, b, a_to_b, triangles_, parameters_.resolution, enough);
  if (of_a >= enough) return of_a;
  triangles_.clear();
  for (const auto& pair : pairs_) triangles_.push_back(pair.b);
  sort_unique(triangles_);
  return std::max(of_a, gauge_.deepest(b, a, b_to_a, triangles_, parameters_.resolution, enough));
}

/// The shrunken copy of a does not meet the surface of b, so each of its shells is inside or outside of b as a
/// whole; outside, each point of a is within `depth` of a point outside b, hence no deeper.
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
  return std::max(0.0, measure(a, pose_a, b, pose_b, allowed + parameters_.depth_limit) - allowed);
}

}  // namespace dismantle::mesh_collision
