#include "dismantle/geometry/triangle_bvh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "dismantle/geometry/numerics.h"

namespace dismantle {
namespace {

constexpr int kBins = 16;  // of the surface area heuristic: more bins do not improve the trees
using geometry::kNoIndex;

using Vec3 = Eigen::Vector3d;

double half_area(const Aabb& b) {
  if (b.empty()) return 0;
  const Vec3 s = b.size();
  return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

int bin_of(double x, double lo, double scale) { return std::clamp(static_cast<int>((x - lo) * scale), 0, kBins - 1); }

}  // namespace

Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  // Ericson, Real-Time Collision Detection, 5.1.5, with guards for triangles without area.
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double den = d1 - d3;
    return den > 0 ? Vec3(a + (d1 / den) * ab) : a;
  }
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double den = d2 - d6;
    return den > 0 ? Vec3(a + (d2 / den) * ac) : a;
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double den = (d4 - d3) + (d5 - d6);
    return den > 0 ? Vec3(b + ((d4 - d3) / den) * (c - b)) : b;
  }
  const double den = va + vb + vc;
  if (!(den > 0)) return a;
  return a + (vb / den) * ab + (vc / den) * ac;
}

TriangleBvh::TriangleBvh(const Mesh& mesh, const geometry::Poll& poll, Surface surface) {
  const std::size_t n = mesh.triangles.size();
  corners_.resize(n);
  std::vector<Aabb> boxes(n);
  for (std::size_t t = 0; t < n; ++t) {
    for (int k = 0; k < 3; ++k) {
      corners_[t][static_cast<std::size_t>(k)] = mesh.vertex(t, k);
      boxes[t].extend(mesh.vertex(t, k));
    }
  }
  order_.resize(n);
  std::iota(order_.begin(), order_.end(), 0u);
  if (n == 0) return;
  nodes_.reserve(n);
  build(0, static_cast<std::uint32_t>(n), boxes, poll);
  nodes_.shrink_to_fit();
  if (surface == Surface::closed) return;
  dipoles_.resize(nodes_.size());
  for (auto id = static_cast<std::uint32_t>(nodes_.size()); id-- > 0;) sum_up(id);  // children come after their parent
}

void TriangleBvh::build(std::uint32_t first, std::uint32_t count, std::vector<Aabb>& boxes,
                        const geometry::Poll& poll) {
  poll.before(count);
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  Aabb box, centers;
  for (std::uint32_t i = first; i < first + count; ++i) {
    box.extend(boxes[order_[i]]);
    centers.extend(boxes[order_[i]].center());
  }
  nodes_[self].box = box;
  if (count <= 4) {  // a leaf: testing so few triangles costs no more than two boxes
    nodes_[self].first = first;
    nodes_[self].count = count;
    return;
  }
  int axis = 0;
  const Vec3 extent = centers.size();
  extent.maxCoeff(&axis);
  const auto begin = order_.begin() + first, end = begin + count;
  const double lo = centers.lo[axis];
  const double scale = extent[axis] > 0 ? kBins / extent[axis] : 0;

  std::array<Aabb, kBins> bin_box;
  std::array<std::uint32_t, kBins> bin_count{};
  for (auto it = begin; it != end; ++it) {
    const auto b = static_cast<std::size_t>(bin_of(boxes[*it].center()[axis], lo, scale));
    bin_box[b].extend(boxes[*it]);
    ++bin_count[b];
  }
  std::array<double, kBins> right_cost{};
  Aabb sweep;
  std::uint32_t right = 0;
  for (std::size_t b = kBins - 1; b > 0; --b) {
    sweep.extend(bin_box[b]);
    right += bin_count[b];
    right_cost[b] = half_area(sweep) * right;
  }
  double best = std::numeric_limits<double>::infinity();
  int split = -1;
  sweep = Aabb{};
  std::uint32_t left = 0;
  for (std::size_t b = 0; b + 1 < kBins; ++b) {
    sweep.extend(bin_box[b]);
    left += bin_count[b];
    if (left < (count + 7) / 8 || count - left < (count + 7) / 8) continue;
    const double cost = half_area(sweep) * left + right_cost[b + 1];
    if (cost < best) {
      best = cost;
      split = static_cast<int>(b);
    }
  }
  auto middle = begin + count / 2;
  if (split >= 0) {
    middle = std::stable_partition(
        begin, end, [&](std::uint32_t t) { return bin_of(boxes[t].center()[axis], lo, scale) <= split; });
  } else {
    std::sort(begin, end, [&](std::uint32_t a, std::uint32_t b) {
      return std::make_pair(boxes[a].center()[axis], a) < std::make_pair(boxes[b].center()[axis], b);
    });
  }
  const auto left_count = static_cast<std::uint32_t>(middle - begin);
  build(first, left_count, boxes, poll);
  nodes_[self].first = static_cast<std::uint32_t>(nodes_.size());
  build(first + left_count, count - left_count, boxes, poll);
}

ClosestPoint TriangleBvh::closest(const Vec3& p, double limit) const {
  ClosestPoint result;
  if (nodes_.empty()) return result;
  double best =
      limit < std::numeric_limits<double>::infinity() ? limit * limit : std::numeric_limits<double>::infinity();
  struct Entry {
    double d;
    std::uint32_t node;
  };
  std::array<Entry, kStackSize> stack;
  std::size_t top = 0;
  Entry at{nodes_[0].box.squared_distance(p), 0};
  if (at.d > best) return result;
  for (;;) {
    const Node& node = nodes_[at.node];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const auto& c = corners_[order_[i]];
        const Vec3 q = closest_on_triangle(p, c[0], c[1], c[2]);
        const double d = (q - p).squaredNorm();
        if (d < best || (d == best && order_[i] < result.triangle)) {
          best = d;
          result.point = q;
          result.triangle = order_[i];
        }
      }
    } else {
      Entry near{nodes_[at.node + 1].box.squared_distance(p), at.node + 1};
      Entry far{nodes_[node.first].box.squared_distance(p), node.first};
      if (far.d < near.d) std::swap(near, far);
      if (far.d <= best) stack[top++] = far;
      if (near.d <= best) {
        at = near;
        continue;
      }
    }
    do {
      if (top == 0) {
        if (result.triangle != kNoIndex) result.distance = std::sqrt(best);
        return result;
      }
      at = stack[--top];
    } while (at.d > best);
  }
}

double TriangleBvh::signed_distance(const Vec3& p) const {
  const double d = closest(p).distance;
  return inside(p) ? -d : d;
}

/// Calls f(triangle) for each triangle whose box `meets`, which must be true for every box around a box for which it
/// is.
template <class Meets>
void TriangleBvh::visit(const Meets& meets, const std::function<void(std::uint32_t)>& f) const {
  if (nodes_.empty()) return;
  std::array<std::uint32_t, kStackSize> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t id = stack[--top];
    const Node& node = nodes_[id];
    if (!meets(node.box)) continue;
    if (node.count == 0) {
      stack[top++] = node.first;
      stack[top++] = id + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const auto& c = corners_[order_[i]];
      if (meets(Aabb{c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2])})) f(order_[i]);
    }
  }
}

void TriangleBvh::overlapping(const Aabb& box, const std::function<void(std::uint32_t)>& f) const {
  visit([&](const Aabb& b) { return b.overlaps(box); }, f);
}

void TriangleBvh::overlapping(const Aabb& box, const Vec3& point, const Vec3& normal,
                              const std::function<void(std::uint32_t)>& f) const {
  const Vec3 spread = normal.cwiseAbs();
  const auto meets = [&](const Aabb& b) {
    if (!b.overlaps(box)) return false;
    const Vec3 to = b.center() - point, half = 0.5 * b.size();
    // The margin covers rounding: a triangle that the plane divides is never left out.
    return std::abs(normal.dot(to)) <= spread.dot(half) + 1e-12 * (to.norm() + half.norm());
  };
  visit(meets, f);
}

}  // namespace dismantle
