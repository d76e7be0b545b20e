// Gilbert-Johnson-Keerthi search for the shortest vector between two hulls; each support query yields a candidate plane
// with its exact gap, so the answer is certified by construction.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "convex_set.h"

namespace dismantle {
namespace {

const Eigen::Vector3d& farthest(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& n) {
  std::size_t best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double d = n.dot(points[i]);
    if (d > most) most = d, best = i;
  }
  return points[best];
}

geometry::ConvexSet hull_of(std::span<const Eigen::Vector3d> points) {
  double extent = 0;
  for (const auto& p : points) extent = std::max(extent, p.cwiseAbs().maxCoeff());
  return {points.front(), extent, [points](const Eigen::Vector3d& n) { return farthest(points, n); }};
}

struct Simplex {
  std::array<Eigen::Vector3d, 4> p;
  int size = 0;
};

/// Shortest vector from the origin to the hull of the chosen corners, if its foot lies within them.
bool nearest_on_subset(const Simplex& s, unsigned mask, Eigen::Vector3d& nearest) {
  std::array<int, 4> id{};
  int n = 0;
  for (int i = 0; i < s.size; ++i)
    if (mask & (1u << i)) id[static_cast<std::size_t>(n++)] = i;
  const Eigen::Vector3d& o = s.p[static_cast<std::size_t>(id[0])];
  if (n == 1) {
    nearest = o;
    return true;
  }
  if (n == 4) {  // origin inside the tetrahedron
    Eigen::Matrix3d m;
    for (int i = 1; i < 4; ++i) m.col(i - 1) = s.p[static_cast<std::size_t>(id[static_cast<std::size_t>(i)])] - o;
    const double det = m.determinant();
    if (std::abs(det) < 1e-18 * m.col(0).norm() * m.col(1).norm() * m.col(2).norm()) return false;
    const Eigen::Vector3d l = m.inverse() * (-o);
    if (!(l.minCoeff() >= 0) || !(l.sum() <= 1)) return false;
    nearest.setZero();
    return true;
  }
  const Eigen::Vector3d e1 = s.p[static_cast<std::size_t>(id[1])] - o;
  const double a11 = e1.squaredNorm(), b1 = -e1.dot(o);
  if (n == 2) {
    if (!(a11 > 0)) return false;
    const double t = b1 / a11;
    if (!(t >= 0 && t <= 1)) return false;
    nearest = o + t * e1;
    return true;
  }
  const Eigen::Vector3d e2 = s.p[static_cast<std::size_t>(id[2])] - o;
  const Eigen::Vector3d normal = e1.cross(e2);
  const double nn = normal.squaredNorm();
  if (!(nn > 1e-28 * a11 * e2.squaredNorm())) return false;
  const double t1 = -o.cross(e2).dot(normal) / nn, t2 = -e1.cross(o).dot(normal) / nn;
  if (!(t1 >= 0 && t2 >= 0 && t1 + t2 <= 1)) return false;
  nearest = (o.dot(normal) / nn) * normal;
  return true;
}

/// Reduces the simplex to the corners that support the shortest vector, and returns that vector.
Eigen::Vector3d reduce(Simplex& s) {
  double best = std::numeric_limits<double>::infinity();
  unsigned best_mask = 1;
  Eigen::Vector3d nearest = s.p[0];
  for (unsigned mask = 1; mask < (1u << s.size); ++mask) {
    Eigen::Vector3d v;
    if (!nearest_on_subset(s, mask, v)) continue;
    if (v.squaredNorm() < best) {
      best = v.squaredNorm();
      best_mask = mask;
      nearest = v;
    }
  }
  Simplex kept;
  for (int i = 0; i < s.size; ++i)
    if (best_mask & (1u << i)) kept.p[static_cast<std::size_t>(kept.size++)] = s.p[static_cast<std::size_t>(i)];
  s = kept;
  return nearest;
}

}  // namespace

std::optional<Separation> geometry::separate(const ConvexSet& a, const ConvexSet& b, double min_gap) {
  const double extent = std::max(a.extent, b.extent);
  // A gap below the rounding of its own dot products proves nothing.
  const double needed = std::max(min_gap, 16 * std::numeric_limits<double>::epsilon() * extent);

  Separation best{Eigen::Vector3d::UnitX(), -std::numeric_limits<double>::infinity()};
  Simplex simplex;
  simplex.p[0] = b.any - a.any;
  simplex.size = 1;
  Eigen::Vector3d v = simplex.p[0];
  for (int i = 0; i < 256; ++i) {  // GJK converges in a few dozen rounds; the limit stops cycles due to rounding
    const double length = v.norm();
    if (!(length > 1e-15 * extent)) break;  // the hulls share a point
    const Eigen::Vector3d n = v / length;
    const Eigen::Vector3d top = a.farthest(n), bottom = b.farthest(-n);
    const double gap = -(-n).dot(bottom) - n.dot(top);
    if (gap > best.gap) best = {n, gap};
    if (length - gap <= 1e-9 * length) break;  // converged: n is the widest gap
    simplex.p[static_cast<std::size_t>(simplex.size++)] = bottom - top;
    const Eigen::Vector3d next = reduce(simplex);
    if (!(next.squaredNorm() < v.squaredNorm()) || simplex.size == 4) break;  // no progress, or the origin is within
    v = next;
  }
  if (!(best.gap > needed)) return std::nullopt;
  return best;
}

std::optional<Separation> separate(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b,
                                   double min_gap) {
  if (a.empty() || b.empty()) return std::nullopt;
  return geometry::separate(hull_of(a), hull_of(b), min_gap);
}

}  // namespace dismantle
