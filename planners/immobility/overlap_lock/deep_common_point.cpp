#include "overlap_lock/deep_common_point.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/relative_motion.h"
#include "dismantle/immobility/geometry_names.h"

namespace dismantle::immobility {
namespace {

struct Cube {
  Eigen::Vector3d center;
  double half = 0;
  double in_a = 0, in_b = 0;  ///< depth of its centre
  double bound = 0;           ///< upper bound of the depth of its points
  bool operator<(const Cube& other) const { return bound < other.bound; }
};

Aabb world_box(const Solid& s, const Pose& pose) {
  Aabb box;
  for (const auto& v : s.mesh.vertices) box.extend(pose * v);
  return box;
}

/// A point in the frame of a solid, and its depth below the surface (< 0: outside).
struct DepthSample {
  Eigen::Vector3d at;
  double depth = 0;
};

/// Depth of `p`, if it is more than `least`. The distances from the box and from the surface are upper bounds of it,
/// and mostly decide. The inside test of `p` costs as much again. It is not needed where the balls about `p` and `near`
/// that do not meet the surface overlap, since then both points are on one side.
std::optional<double> depth_above(double least, const Eigen::Vector3d& p, const Solid& solid,
                                  std::optional<DepthSample>& near) {
  if (!((p - solid.box.lo).cwiseMin(solid.box.hi - p).minCoeff() > least)) return std::nullopt;
  const double distance = solid.bvh.closest(p).distance;
  if (distance <= least) return std::nullopt;
  const bool same_side = near && (p - near->at).norm() < (1 - kRounding) * (std::abs(near->depth) + distance);
  const bool inside = same_side ? near->depth > 0 : solid.bvh.inside(p);
  near = {p, inside ? distance : -distance};
  return near->depth > least ? std::optional(near->depth) : std::nullopt;
}

}  // namespace

std::optional<DeepPoint> deep_common_point(const Solid& a, const Pose& pose_a, const Solid& b, const Pose& pose_b,
                                           double limit, std::uint64_t most_cubes) {
  Aabb box = world_box(a, pose_a);
  const Aabb other = world_box(b, pose_b);
  box.lo = box.lo.cwiseMax(other.lo);
  box.hi = box.hi.cwiseMin(other.hi);
  if (!(box.size().minCoeff() > 0)) return std::nullopt;
  const Placement to_a(pose_a.inverse()), to_b(pose_b.inverse());
  std::priority_queue<Cube> open;
  std::optional<DeepPoint> found;
  std::optional<DepthSample> near_a, near_b;  // the last points
  const auto add = [&](const Eigen::Vector3d& center, double half) {
    const double reach = std::sqrt(3.0) * half;
    const auto in_a = depth_above(limit - reach, to_a * center, a, near_a);
    if (!in_a) return;
    const auto in_b = depth_above(-reach, to_b * center, b, near_b);
    if (!in_b) return;
    if (*in_a > limit && *in_b > 0) {
      found = DeepPoint{center, *in_a};
      return;
    }
    open.push({center, half, *in_a, *in_b, std::min(*in_a, *in_b + limit) + reach});
  };
  // The first cubes have the shortest edge of the common box, but no less than a twentieth of the longest.
  const double half = 0.5 * std::max(box.size().minCoeff(), 0.05 * box.size().maxCoeff());
  const Eigen::Array3i count = (box.size() / (2 * half)).array().ceil().cast<int>().max(1);
  for (int x = 0; x < count.x(); ++x)
    for (int y = 0; y < count.y(); ++y)
      for (int z = 0; z < count.z() && !found; ++z)
        add(box.lo + half * (2.0 * Eigen::Vector3d(x, y, z) + Eigen::Vector3d::Ones()), half);
  for (std::uint64_t cubes = 0; !found && !open.empty() && cubes < most_cubes; ++cubes) {
    const Cube cube = open.top();
    open.pop();
    near_a = {to_a * cube.center, cube.in_a};
    near_b = {to_b * cube.center, cube.in_b};
    for (int k = 0; k < 8 && !found; ++k)
      add(cube.center + 0.5 * cube.half * Eigen::Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1),
          0.5 * cube.half);
  }
  return found;
}

}  // namespace dismantle::immobility
