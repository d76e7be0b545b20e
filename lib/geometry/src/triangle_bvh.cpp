#include "dismantle/geometry/triangle_bvh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/solid_angles.h"

namespace dismantle {
namespace {

constexpr int kBins = 16;  // of the surface area heuristic: more bins do not improve the trees
// Each side of a split keeps at least an eighth of the triangles, so 2^32 of them make less than 180 levels.
constexpr std::size_t kStackSize = 192;
using geometry::kNoIndex;

using Vec3 = Eigen::Vector3d;

double half_area(const Aabb& b) {
  if (b.empty()) return 0;
  const Vec3 s = b.size();
  return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

int bin_of(double x, double lo, double scale) { return std::clamp(static_cast<int>((x - lo) * scale), 0, kBins - 1); }

/// Directions unrelated to the axes of parts: degenerate hits are rare, and another direction resolves them.
const std::array<Vec3, 6>& ray_directions() {
  static const std::array<Vec3, 6> directions = {Vec3(0.3716542397, 0.8410289143, 0.3930517461).normalized(),
                                                 Vec3(-0.7593180147, 0.2416790533, 0.6041392275).normalized(),
                                                 Vec3(0.5287419031, -0.4471360829, 0.7214568307).normalized(),
                                                 Vec3(-0.1938274651, -0.6572910483, -0.7283190417).normalized(),
                                                 Vec3(0.9012375501, 0.1374920683, -0.4109838127).normalized(),
                                                 Vec3(-0.4719283746, 0.6829174650, -0.5572839107).normalized()};
  return directions;
}

/// Towards the nearest face of the box, so that the ray meets few triangles; oblique for the same reason.
Vec3 direction_out(const Aabb& box, const Vec3& p) {
  Eigen::Index high = 0, low = 0;
  const double up = (box.hi - p).minCoeff(&high), down = (p - box.lo).minCoeff(&low);
  const Eigen::Index axis = up <= down ? high : low;
  Vec3 direction;
  direction[axis] = up <= down ? 1 : -1;
  direction[(axis + 1) % 3] = 0.2136418943;
  direction[(axis + 2) % 3] = 0.3371962057;
  return direction.normalized();
}

/// A ray and two directions across it, onto which triangles are projected.
struct RayFrame {
  Vec3 origin, along, across, up;
};

RayFrame make_frame(const Vec3& origin, const Vec3& along) {
  const Vec3 across = along.cross(Vec3::UnitX()).normalized();
  return {origin, along, across, along.cross(across)};
}

struct Crossings {
  int winding = 0;
  bool degenerate = false;  ///< an edge was hit to within rounding
};

/// Signed crossings of one triangle. Edge signs of two triangles that share an edge are computed from the
/// same numbers, so contributions along inner edges cancel exactly.
void count_triangle(const std::array<Vec3, 3>& c, const RayFrame& ray, Crossings& sum) {
  std::array<double, 3> x, y, z;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 r = c[i] - ray.origin;
    x[i] = r.dot(ray.across);
    y[i] = r.dot(ray.up);
    z[i] = r.dot(ray.along);
  }
  if (std::max({z[0], z[1], z[2]}) < 0) return;
  if (std::max({x[0], x[1], x[2]}) < 0 || std::min({x[0], x[1], x[2]}) > 0) return;
  if (std::max({y[0], y[1], y[2]}) < 0 || std::min({y[0], y[1], y[2]}) > 0) return;
  std::array<double, 3> e;
  bool positive = false, negative = false, unsure = false;
  int turns = 0;  // twice the winding of the triangle's outline about the ray, by crossings of the half axis x > 0
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double p = x[i] * y[j], q = y[i] * x[j];
    e[i] = p - q;
    // x and y have the rounding of their dot products in addition to that of the products here.
    const double size = std::max(std::abs(x[i]), std::abs(y[i])) + std::max(std::abs(x[j]), std::abs(y[j]));
    const double error = 1e-14 * (size + std::abs(z[i]) + std::abs(z[j])) * size;
    if (std::abs(e[i]) <= error)
      unsure = true;
    else
      (e[i] > 0 ? positive : negative) = true;
    if ((y[i] < 0) != (y[j] < 0)) {
      if (y[i] < 0 && e[i] > 0) ++turns;
      if (y[i] >= 0 && e[i] < 0) --turns;
    }
  }
  if (positive && negative) return;  // clearly beside the triangle
  if (unsure) sum.degenerate = true;
  if (turns == 0) return;
  const double total = e[0] + e[1] + e[2];
  const double hit = total != 0 ? (e[1] * z[0] + e[2] * z[1] + e[0] * z[2]) / total : std::max({z[0], z[1], z[2]});
  if (hit > 0) sum.winding += turns;  // seen from inside, an outward triangle turns counter-clockwise about the ray
}

bool ray_meets(const Aabb& box, const Vec3& origin, const Vec3& inverse) {
  double from = 0, to = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    double a = (box.lo[k] - origin[k]) * inverse[k], b = (box.hi[k] - origin[k]) * inverse[k];
    if (a > b) std::swap(a, b);
    from = std::max(from, a - 1e-12 * std::abs(a));
    to = std::min(to, b + 1e-12 * std::abs(b));
  }
  return from <= to;
}

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

int TriangleBvh::winding_number(const Vec3& p) const {
  if (nodes_.empty() || !nodes_[0].box.contains(p)) return 0;
  Crossings sum;
  for (std::size_t attempt = 0; attempt <= ray_directions().size(); ++attempt) {
    const Vec3 direction = attempt == 0 ? direction_out(nodes_[0].box, p) : ray_directions()[attempt - 1];
    const RayFrame ray = make_frame(p, direction);
    const Vec3 inverse = direction.cwiseInverse();
    sum = {};
    std::array<std::uint32_t, kStackSize> stack;
    std::size_t top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const std::uint32_t id = stack[--top];
      const Node& node = nodes_[id];
      if (!ray_meets(node.box, p, inverse)) continue;
      if (node.count == 0) {
        stack[top++] = node.first;
        stack[top++] = id + 1;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        count_triangle(corners_[order_[i]], ray, sum);
    }
    if (!sum.degenerate) break;
  }
  return sum.winding;
}

/// The centre of a node is the mean of its box: any point will do, since `reach` bounds the error.
void TriangleBvh::sum_up(std::uint32_t id) {
  const Node& node = nodes_[id];
  Dipole& sum = dipoles_[id];
  sum.center = node.box.center();
  sum.area = Vec3::Zero();
  if (node.count == 0) {
    sum.area = dipoles_[id + 1].area + dipoles_[node.first].area;
    sum.reach = 0.5 * node.box.size().norm();
    return;
  }
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
    const auto& c = corners_[order_[i]];
    sum.area += 0.5 * (c[1] - c[0]).cross(c[2] - c[0]);
    for (const Vec3& p : c) sum.reach = std::max(sum.reach, (p - sum.center).norm());
  }
}

double TriangleBvh::generalised_winding_number(const Vec3& p) const {
  constexpr double kFar = 4;  // in reaches: an error below 0.01 of the whole sphere
  if (dipoles_.empty()) return winding_number(p);
  double far = 0;
  SolidAngles near;
  std::array<std::uint32_t, kStackSize> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t id = stack[--top];
    const Node& node = nodes_[id];
    const Dipole& sum = dipoles_[id];
    const Vec3 to = sum.center - p;
    if (const double distance = to.norm(); distance > kFar * sum.reach) {
      far += sum.area.dot(to) / (distance * distance * distance);
    } else if (node.count == 0) {
      stack[top++] = node.first;
      stack[top++] = id + 1;
    } else {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const auto& c = corners_[order_[i]];
        near.add(c[0] - p, c[1] - p, c[2] - p);
      }
    }
  }
  return (far + near.sum()) / (4 * std::numbers::pi);
}

bool TriangleBvh::inside(const Vec3& p) const {
  if (dipoles_.empty()) return winding_number(p) > 0;
  return nodes_[0].box.contains(p) && generalised_winding_number(p) > 0.5;
}

double TriangleBvh::signed_distance(const Vec3& p) const {
  const double d = closest(p).distance;
  return inside(p) ? -d : d;
}

void TriangleBvh::overlapping(const Aabb& box, const std::function<void(std::uint32_t)>& f) const {
  if (nodes_.empty()) return;
  std::array<std::uint32_t, kStackSize> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t id = stack[--top];
    const Node& node = nodes_[id];
    if (!node.box.overlaps(box)) continue;
    if (node.count == 0) {
      stack[top++] = node.first;
      stack[top++] = id + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const auto& c = corners_[order_[i]];
      Aabb b;
      for (const auto& v : c) b.extend(v);
      if (b.overlaps(box)) f(order_[i]);
    }
  }
}

}  // namespace dismantle
