#include "dismantle/geometry/hulls_apart.h"

#include <algorithm>
#include <array>
#include <cmath>
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
  levels.emplace_back(parts.size());
  while (levels.back().size() > kRun) levels.emplace_back((levels.back().size() + kRun - 1) / kRun);
  set_boxes();
}

void HullsApart::Side::move_to(const Vec3& shift) {
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].pose.t = begin[i] + shift;
  set_boxes();
}

void HullsApart::Side::set_boxes() {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PlacedHull& p = parts[i];
    levels[0][i] =
        p.pose.q.vec().isZero(0) ? Aabb{p.box->lo + p.pose.t, p.box->hi + p.pose.t} : box_under(*p.box, p.pose);
  }
  for (std::size_t l = 1; l < levels.size(); ++l) {
    std::fill(levels[l].begin(), levels[l].end(), Aabb{});
    for (std::size_t i = 0; i < levels[l - 1].size(); ++i) levels[l][i / kRun].extend(levels[l - 1][i]);
  }
}

/// Calls visit(i) for the parts, of those under kRun boxes of a level from `first` on, that may reach as far as
/// `least`, which visits raise. `bound`: how far what is in a box may reach. The box with the largest bound comes
/// first, so that few others remain.
template <class Bound, class Visit>
void HullsApart::Side::visit_farthest(std::size_t level, std::size_t first, const Bound& bound, const double& least,
                                      const Visit& visit) const {
  const std::vector<Aabb>& boxes = levels[level];
  const std::size_t count = std::min(kRun, boxes.size() - first);
  if (count == 0) return;
  std::array<double, kRun> most{};
  for (std::size_t k = 0; k < count; ++k) most[k] = bound(boxes[first + k]);
  const auto descend = [&](std::size_t k) {
    if (level == 0)
      visit(first + k);
    else
      visit_farthest(level - 1, (first + k) * kRun, bound, least, visit);
  };
  const auto farthest = static_cast<std::size_t>(std::max_element(most.begin(), most.begin() + count) - most.begin());
  if (most[farthest] >= least) descend(farthest);
  for (std::size_t k = 0; k < count; ++k)
    if (k != farthest && most[k] >= least) descend(k);
}

/// The corner farthest along `normal`; among equals the first one, whatever the order of visits.
Eigen::Vector3d HullsApart::Side::farthest(const Vec3& normal) const {
  double top = -std::numeric_limits<double>::infinity();
  std::size_t part = 0;
  Vec3 corner = Vec3::Zero();
  const auto bound = [&](const Aabb& box) { return top_of(box, normal); };
  visit_farthest(levels.size() - 1, 0, bound, top, [&](std::size_t i) {
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
double HullsApart::Side::top(const Vec3& normal) const {
  double top = -std::numeric_limits<double>::infinity();
  const auto bound = [&](const Aabb& box) { return top_of(box, normal); };
  visit_farthest(levels.size() - 1, 0, bound, top, [&](std::size_t i) {
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
  const auto bound = [&](const Aabb& box) {
    const double end = sign > 0 ? box.hi[k] : -box.lo[k];
    return end + kRounding * (std::abs(end) + box.size()[k]);
  };
  visit_farthest(levels.size() - 1, 0, bound, top, [&](std::size_t i) {
    const PlacedHull& p = parts[i];
    if (p.pose.q.vec().isZero(0)) {
      top = std::max(top, sign > 0 ? p.box->hi[k] + p.pose.t[k] : -(p.box->lo[k] + p.pose.t[k]));
    } else {
      for (const Vec3& v : p.mesh->vertices) top = std::max(top, sign * (p.pose * v)[k]);
    }
  });
  return top;
}

Aabb HullsApart::Side::box() const {
  Aabb all;
  for (const Aabb& run : levels.back()) all.extend(run);
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
