/// Penetration by brute force, sharing nothing with the verifier: points on one surface, a ray through every triangle
/// of the other to tell inside from outside, and the distance to every triangle.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "dismantle/mesh.h"
#include "dismantle/pose.h"

namespace dismantle::trust {

using Vec3 = Eigen::Vector3d;

/// Points on the surface, no two neighbours further apart than `spacing`: corners, and a lattice on every triangle.
inline std::vector<Vec3> surface_points(const Mesh& mesh, double spacing) {
  std::vector<Vec3> points = mesh.vertices;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.vertex(t, 0), ab = mesh.vertex(t, 1) - a, ac = mesh.vertex(t, 2) - a;
    const double longest = std::max({ab.norm(), ac.norm(), (ab - ac).norm()});
    const int n = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
    for (int i = 0; i <= n; ++i)
      for (int k = 0; i + k <= n; ++k) points.push_back(a + ab * i / n + ac * k / n);
  }
  return points;
}

/// Inside or outside of a mesh, by the parity of the crossings of a ray. Its direction is no ratio of small numbers: a
/// ray from a lattice point must not meet an edge between two triangles, where it would count twice or not at all.
class RayParity {
 public:
  explicit RayParity(const Mesh& mesh) : mesh_(mesh), across_(direction().unitOrthogonal()) {
    const Vec3 second = direction().cross(across_);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      Box box;
      for (int k = 0; k < 3; ++k) {
        const Vec3 v = mesh.vertex(t, k);
        const Eigen::Vector2d shadow(v.dot(across_), v.dot(second));
        box.extend(Box(shadow.array() - kSlack, shadow.array() + kSlack));
      }
      shadows_.push_back(box);
    }
  }

  bool inside(const Vec3& p) const {
    const Vec3 d = direction();
    const Eigen::Vector2d shadow(p.dot(across_), p.dot(d.cross(across_)));
    int crossings = 0;
    for (std::size_t t = 0; t < shadows_.size(); ++t)
      if (shadows_[t].contains(shadow)) crossings += crosses(p, d, t) ? 1 : 0;
    return crossings % 2 == 1;
  }

 private:
  using Box = Eigen::AlignedBox2d;
  static constexpr double kSlack = 1e-6;  // far above rounding: no triangle that the ray meets is left out

  static Vec3 direction() { return Vec3(0.31415926535, 0.57721566490, 0.75487766624).normalized(); }

  bool crosses(const Vec3& p, const Vec3& d, std::size_t t) const {
    const Vec3 a = mesh_.vertex(t, 0), u = mesh_.vertex(t, 1) - a, v = mesh_.vertex(t, 2) - a, h = d.cross(v);
    const double det = u.dot(h);
    if (std::abs(det) < 1e-300) return false;
    const double x = (p - a).dot(h) / det;
    if (x < 0 || x > 1) return false;
    const Vec3 q = (p - a).cross(u);
    const double y = d.dot(q) / det;
    return y >= 0 && x + y <= 1 && v.dot(q) / det > 0;
  }

  const Mesh& mesh_;
  Vec3 across_;
  std::vector<Box> shadows_;  // of the triangles, along the ray
};

inline double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double n = d.squaredNorm(), s = n > 0 ? std::clamp((p - a).dot(d) / n, 0.0, 1.0) : 0;
  return (p - a - s * d).norm();
}

inline double distance_to_surface(const Vec3& p, const Mesh& mesh) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.vertex(t, 0), b = mesh.vertex(t, 1), c = mesh.vertex(t, 2), n = (b - a).cross(c - a);
    if (n.squaredNorm() > 0) {
      const Vec3 q = p - n * (n.dot(p - a) / n.squaredNorm());
      if (n.dot((b - a).cross(q - a)) >= 0 && n.dot((c - b).cross(q - b)) >= 0 && n.dot((a - c).cross(q - c)) >= 0)
        best = std::min(best, (p - q).norm());
    }
    best = std::min({best, distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
  }
  return best;
}

/// Deepest of the points of one part in another; a lower bound of the depth. `relative` takes them to the other's
/// frame.
inline double deepest_of(const std::vector<Vec3>& points, const Pose& relative, const Mesh& other) {
  const Aabb box = other.box();
  const RayParity parity(other);
  double depth = 0;
  for (const Vec3& at : points) {
    const Vec3 p = relative * at;
    if ((p - box.lo).minCoeff() <= depth || (box.hi - p).minCoeff() <= depth) continue;  // no deeper than found
    if (parity.inside(p)) depth = std::max(depth, distance_to_surface(p, other));
  }
  return depth;
}

}  // namespace dismantle::trust
