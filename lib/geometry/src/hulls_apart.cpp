#include "dismantle/geometry/hulls_apart.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "convex_set.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/swept_boxes.h"

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;

/// geometry::top_of() for an axis-aligned box.
double top_of(const Aabb& box, const Vec3& normal) {
  const Vec3 middle = box.center(), half = 0.5 * box.size();
  return normal.dot(middle) + (1 + kRounding) * normal.cwiseAbs().dot(half) + kRounding * middle.norm();
}

}  // namespace

HullsApart::Side::Side(std::vector<PlacedHull> placed) : parts(std::move(placed)) {
  std::erase_if(parts, [](const PlacedHull& p) { return p.corners->empty(); });
  begin.reserve(parts.size());
  for (const PlacedHull& p : parts) begin.push_back(p.pose.t);
  boxes.resize(parts.size());
  runs.resize((parts.size() + kRun - 1) / kRun);
  most.resize(runs.size());
  set_boxes();
}

void HullsApart::Side::move_to(const Vec3& shift) {
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].pose.t = begin[i] + shift;
  set_boxes();
}

void HullsApart::Side::set_boxes() {
  std::fill(runs.begin(), runs.end(), Aabb{});
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PlacedHull& p = parts[i];
    boxes[i] = p.pose.q.vec().isZero(0) ? Aabb{p.box->lo + p.pose.t, p.box->hi + p.pose.t} : box_under(*p.box, p.pose);
    runs[i / kRun].extend(boxes[i]);
  }
}

/// Calls visit(i) for the parts that may reach as far as `least`, which visits raise. The run with the largest bound
/// comes first, so that few others remain.
template <class Visit>
void HullsApart::Side::visit_farthest(const Vec3& normal, const double& least, const Visit& visit) {
  for (std::size_t r = 0; r < runs.size(); ++r) most[r] = top_of(runs[r], normal);
  const auto visit_run = [&](std::size_t r) {
    for (std::size_t i = r * kRun; i < std::min(parts.size(), (r + 1) * kRun); ++i)
      if (top_of(boxes[i], normal) >= least) visit(i);
  };
  const auto first = static_cast<std::size_t>(std::max_element(most.begin(), most.end()) - most.begin());
  visit_run(first);
  for (std::size_t r = 0; r < runs.size(); ++r)
    if (r != first && most[r] >= least) visit_run(r);
}

/// The corner farthest along `normal`; among equals the first one, whatever the order of visits.
Eigen::Vector3d HullsApart::Side::farthest(const Vec3& normal) {
  double top = -std::numeric_limits<double>::infinity();
  std::size_t part = 0;
  Vec3 corner = Vec3::Zero();
  visit_farthest(normal, top, [&](std::size_t i) {
    double own = -std::numeric_limits<double>::infinity();
    Vec3 best = Vec3::Zero();
    for (const Vec3& c : *parts[i].corners) {
      const Vec3 p = parts[i].pose * c;
      if (const double d = normal.dot(p); d > own) own = d, best = p;
    }
    if (own > top || (own == top && i < part)) top = own, part = i, corner = best;
  });
  return corner;
}

/// Largest extent of all vertices along `normal`: qhull omits vertices within rounding of a face.
double HullsApart::Side::top(const Vec3& normal) {
  double top = -std::numeric_limits<double>::infinity();
  visit_farthest(normal, top, [&](std::size_t i) {
    const PlacedHull& p = parts[i];
    for (const Vec3& c : *p.corners) top = std::max(top, normal.dot(p.pose * c));
    if (geometry::top_of(*p.box, p.pose, normal) < top) return;  // no vertex of most parts can exceed it
    for (const Vec3& v : p.mesh->vertices) top = std::max(top, normal.dot(p.pose * v));
  });
  return top;
}

/// The same along axis `k` or against it. For unrotated parts the box gives the same value: rounding is monotonic.
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

Aabb HullsApart::Side::box() const {
  Aabb all;
  for (const Aabb& run : runs) all.extend(run);
  return all;
}

HullsApart::HullsApart(std::vector<PlacedHull> group, std::vector<PlacedHull> rest)
    : group_(std::move(group)), rest_(std::move(rest)) {}

bool HullsApart::after(const Vec3& shift) {
  if (group_.parts.empty() || rest_.parts.empty()) return true;
  group_.move_to(shift);
  const Aabb ours = group_.box(), theirs = rest_.box();
  for (Eigen::Index k = 0; k < 3; ++k)  // most parts leave along an axis
    for (const double sign : {1.0, -1.0})
      if ((sign > 0 ? ours.hi[k] < theirs.lo[k] : ours.lo[k] > theirs.hi[k]) &&
          -rest_.top_along(k, -sign) > group_.top_along(k, sign))
        return true;
  const auto set = [](Side& side) {
    const Aabb box = side.box();
    return ConvexSet{side.parts.front().pose * side.parts.front().corners->front(),
                     std::max(box.lo.cwiseAbs().maxCoeff(), box.hi.cwiseAbs().maxCoeff()),
                     [&side](const Vec3& normal) { return side.farthest(normal); }};
  };
  const auto found = separate(set(group_), set(rest_), 0);
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
