#include "dismantle/geometry/sweep.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;

}  // namespace

Sweep::Sweep(const Corners& begin, const Corners& end, double margin) : margin_(margin) {
  for (std::size_t i = 0; i < 3; ++i) {
    hull_[i] = begin[i];
    hull_[i + 3] = end[i];
    box_.extend(begin[i]);
    box_.extend(end[i]);
    edges_[i] = begin[(i + 1) % 3] - begin[i];
  }
  // Error of the few sums and products below, with a margin of 1e3: there are no long chains of operations.
  const double rounding = 1e-12 * std::max(box_.lo.cwiseAbs().maxCoeff(), box_.hi.cwiseAbs().maxCoeff());
  margin_ += rounding;
  box_.inflate(margin_);
  motion_ = ((end[0] - begin[0]) + (end[1] - begin[1]) + (end[2] - begin[2])) / 3;
  for (std::size_t i = 0; i < 3; ++i)
    turning_ = turning_ || (end[i] - begin[i] - motion_).squaredNorm() > rounding * rounding;
  moving_ = motion_.squaredNorm() > rounding * rounding;

  const Vec3 normal = edges_[0].cross(edges_[1]);
  add_axis(normal);
  if (turning_) add_axis((end[1] - end[0]).cross(end[2] - end[1]));
  for (const auto& e : edges_) add_axis(moving_ ? e.cross(motion_) : e.cross(normal));
  // The sides of a sliver that moves along itself have nearly the normal of its face.
  if (moving_) add_axis(normal.cross(motion_));
}

void Sweep::add_axis(const Vec3& n) {
  const double length = n.norm();
  if (!(length > 1e-14)) return;
  Axis a{n / length, (n / length).cwiseAbs(), std::numeric_limits<double>::infinity(),
         -std::numeric_limits<double>::infinity()};
  for (const auto& p : hull_) {
    const double d = a.n.dot(p);
    a.lo = std::min(a.lo, d);
    a.hi = std::max(a.hi, d);
  }
  a.lo -= margin_;
  a.hi += margin_;
  axes_[static_cast<std::size_t>(axis_count_++)] = a;
}

bool Sweep::misses(const Aabb& box) const {
  if (!box.overlaps(box_)) return true;
  const Vec3 c = box.center(), h = 0.5 * box.size();
  for (int i = 0; i < axis_count_; ++i) {
    const Axis& a = axes_[static_cast<std::size_t>(i)];
    const double m = a.n.dot(c), r = a.size.dot(h);
    if (m + r < a.lo || m - r > a.hi) return true;
  }
  return false;
}

bool Sweep::apart_along(const Vec3& n, const Corners& t) const {
  const double length = n.norm();
  if (!(length > 1e-14)) return false;
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (const auto& p : hull_) {
    const double d = n.dot(p);
    lo = std::min(lo, d);
    hi = std::max(hi, d);
  }
  const double grow = margin_ * length;
  const double a = n.dot(t[0]), b = n.dot(t[1]), c = n.dot(t[2]);
  return std::min({a, b, c}) > hi + grow || std::max({a, b, c}) < lo - grow;
}

bool Sweep::apart(const Corners& t) const {
  for (int i = 0; i < axis_count_; ++i) {
    const Axis& x = axes_[static_cast<std::size_t>(i)];
    const double a = x.n.dot(t[0]), b = x.n.dot(t[1]), c = x.n.dot(t[2]);
    if (std::min({a, b, c}) > x.hi || std::max({a, b, c}) < x.lo) return true;
  }
  const std::array<Vec3, 3> sides = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  if (apart_along(sides[0].cross(sides[1]), t)) return true;
  for (const auto& side : sides) {
    if (moving_ && apart_along(side.cross(motion_), t)) return true;
    for (const auto& e : edges_)
      if (apart_along(side.cross(e), t)) return true;
  }
  if (!turning_) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 e = hull_[3 + (i + 1) % 3] - hull_[3 + i], side_edge = hull_[3 + i] - hull_[i];
    if (apart_along(e.cross(side_edge), t)) return true;
    for (const auto& side : sides)
      if (apart_along(side.cross(e), t) || apart_along(side.cross(side_edge), t)) return true;
  }
  return false;
}

SweepResult Sweep::test(const TriangleBvh& bvh) const {
  const auto& nodes = bvh.nodes();
  if (nodes.empty() || misses(nodes[0].box)) return SweepResult::far;
  std::array<std::uint32_t, 192> stack;
  std::size_t top = 0;
  std::uint32_t at = 0;
  for (;;) {
    const TriangleBvh::Node& node = nodes[at];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        if (!apart(bvh.corners(bvh.order()[i]))) return SweepResult::unclear;
    } else {
      const std::uint32_t left = at + 1, right = node.first;
      const bool go_left = !misses(nodes[left].box), go_right = !misses(nodes[right].box);
      if (go_left) {
        if (go_right) stack[top++] = right;
        at = left;
        continue;
      }
      if (go_right) {
        at = right;
        continue;
      }
    }
    if (top == 0) return SweepResult::clear;
    at = stack[--top];
  }
}

std::optional<Vec3> Sweep::beyond(const Plane& plane) const {
  const auto height = [&](const Vec3& p) { return plane.normal.dot(p) - plane.at; };
  const Vec3& highest = *std::max_element(hull_.begin(), hull_.end(),
                                          [&](const Vec3& p, const Vec3& q) { return height(p) < height(q); });
  if (height(highest) > 0) return highest;
  if (height(highest) + margin_ > 0) return highest + margin_ * plane.normal;
  return std::nullopt;
}

bool Sweep::clear_beyond(const TriangleBvh& bvh, const Plane& plane) const {
  const auto height = [&](const Vec3& p) { return plane.normal.dot(p) - plane.at; };
  const auto misses_both = [&](const Aabb& box) {
    return misses(box) || height(box.center()) + plane.normal.cwiseAbs().dot(0.5 * box.size()) < 0;
  };
  const auto is_clear = [&](const Corners& t) {
    const std::array<double, 3> up{height(t[0]), height(t[1]), height(t[2])};
    if (std::max({up[0], up[1], up[2]}) < 0 || apart(t)) return true;
    // The part of the triangle beyond the plane has three or four corners.
    std::array<Vec3, 4> part;
    std::size_t corners = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if (up[i] >= 0) part[corners++] = t[i];
      if ((up[i] < 0) != (up[j] < 0)) part[corners++] = t[i] + up[i] / (up[i] - up[j]) * (t[j] - t[i]);
    }
    for (std::size_t k = 2; k < corners; ++k)
      if (!apart({part[0], part[k - 1], part[k]})) return false;
    return true;
  };
  const auto& nodes = bvh.nodes();
  if (nodes.empty()) return true;
  std::array<std::uint32_t, 192> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t at = stack[--top];
    const TriangleBvh::Node& node = nodes[at];
    if (misses_both(node.box)) continue;
    if (node.count == 0) {
      stack[top++] = node.first;
      stack[top++] = at + 1;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (!is_clear(bvh.corners(bvh.order()[i]))) return false;
  }
  return true;
}

}  // namespace dismantle::geometry
