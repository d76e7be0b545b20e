// Winding numbers of a surface about a point: what is inside.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "dismantle/geometry/solid_angles.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle {
namespace {

using Vec3 = Eigen::Vector3d;

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

}  // namespace dismantle
