#include "dismantle/geometry/hulls_apart.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "dismantle/geometry/hull.h"

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kRounding = 1e-9;  // more than that of a product

Aabb box_of(const std::vector<Vec3>& points) {
  Aabb box;
  for (const Vec3& p : points) box.extend(p);
  return box;
}

}  // namespace

HullsApart::Side::Side(std::vector<PlacedHull> placed) : parts(std::move(placed)) {
  std::size_t count = 0;
  for (const PlacedHull& p : parts) {
    begin.push_back(p.pose.t);
    count += p.corners->size();
  }
  corners.reserve(count);
  for (const PlacedHull& p : parts)
    for (const Vec3& c : *p.corners) corners.push_back(p.pose * c);
}

void HullsApart::Side::move_to(const Vec3& shift) {
  std::size_t at = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].pose.t = begin[i] + shift;
    for (const Vec3& c : *parts[i].corners) corners[at++] = parts[i].pose * c;
  }
}

/// Of all vertices: qhull leaves out those that are within rounding of a face. Most parts have none that could be.
double HullsApart::Side::top(const Vec3& normal) const {
  double top = -std::numeric_limits<double>::infinity();
  for (const Vec3& c : corners) top = std::max(top, normal.dot(c));
  for (const PlacedHull& p : parts) {
    const Vec3 middle = p.pose * p.box->center(), half = 0.5 * p.box->size();
    const double reach = (p.pose.q.conjugate() * normal).cwiseAbs().dot(half);
    if (normal.dot(middle) + (1 + kRounding) * reach + kRounding * middle.norm() < top) continue;
    for (const Vec3& v : p.mesh->vertices) top = std::max(top, normal.dot(p.pose * v));
  }
  return top;
}

/// The same along axis `k` or against it. Rounding keeps the order, so of what is not turned the box tells it, too.
double HullsApart::Side::top_along(Eigen::Index k, double sign) const {
  double top = -std::numeric_limits<double>::infinity();
  for (const PlacedHull& p : parts) {
    if (p.pose.q.vec().isZero(0)) {
      top = std::max(top, sign > 0 ? p.box->hi[k] + p.pose.t[k] : -(p.box->lo[k] + p.pose.t[k]));
    } else {
      for (const Vec3& v : p.mesh->vertices) top = std::max(top, sign * (p.pose * v)[k]);
    }
  }
  return top;
}

HullsApart::HullsApart(std::vector<PlacedHull> group, std::vector<PlacedHull> rest)
    : group_(std::move(group)), rest_(std::move(rest)), theirs_(box_of(rest_.corners)) {}

bool HullsApart::after(const Vec3& shift) {
  if (group_.parts.empty() || rest_.parts.empty()) return true;
  group_.move_to(shift);
  const Aabb ours = box_of(group_.corners);
  for (Eigen::Index k = 0; k < 3; ++k)  // most leave along an axis
    for (const double sign : {1.0, -1.0})
      if ((sign > 0 ? ours.hi[k] < theirs_.lo[k] : ours.lo[k] > theirs_.hi[k]) &&
          -rest_.top_along(k, -sign) > group_.top_along(k, sign))
        return true;
  const auto found = separate(group_.corners, rest_.corners);
  return found && -rest_.top(-found->normal) > group_.top(found->normal);
}

double HullsApart::distance(const Vec3& direction, double most, int bisections) {
  double within = 0, apart = most;
  for (int k = 0; k < bisections; ++k) {
    const double middle = 0.5 * (within + apart);
    (after(middle * direction) ? apart : within) = middle;
  }
  return apart;
}

}  // namespace dismantle::geometry
