#include "verify/patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace dismantle::verify {
namespace {
using Vec3 = Eigen::Vector3d;
}

double Patch::longest_edge() const {
  return std::sqrt(std::max({(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()}));
}

double Patch::radius() const {
  const Vec3 c = center();
  return std::sqrt(std::max({(p[0] - c).squaredNorm(), (p[1] - c).squaredNorm(), (p[2] - c).squaredNorm()}));
}

std::array<Patch, 4> Patch::quarters() const {
  const auto middle = [](const Corners& c) {
    return Corners{0.5 * (c[0] + c[1]), 0.5 * (c[1] + c[2]), 0.5 * (c[2] + c[0])};
  };
  const Corners m = middle(p), i = middle(inward);
  return {Patch{{p[0], m[0], m[2]}, {inward[0], i[0], i[2]}, triangle},
          Patch{{m[0], p[1], m[1]}, {i[0], inward[1], i[1]}, triangle},
          Patch{{m[2], m[1], p[2]}, {i[2], i[1], inward[2]}, triangle},
          Patch{{m[0], m[1], m[2]}, {i[0], i[1], i[2]}, triangle}};
}

Corners moved_by_vertices(const Patch& patch, double depth) {
  return {patch.p[0] + depth * patch.inward[0], patch.p[1] + depth * patch.inward[1],
          patch.p[2] + depth * patch.inward[2]};
}

Corners moved_by_normal(const Patch& patch, const Solid& solid, double depth) {
  constexpr double kAcross = 0.02;
  static const double along = std::sqrt(1 - kAcross * kAcross);
  const Vec3& n = solid.normals[patch.triangle];
  Corners moved = patch.p;
  for (std::size_t i = 0; i < 3; ++i)
    moved[i] += depth * (kAcross * (patch.inward[i] - patch.inward[i].dot(n) * n) - along * n);
  return moved;
}

double depth_at(const Vec3& point, const Solid& solid) {
  const double distance = solid.bvh.closest(point).distance;
  return solid.bvh.inside(point) ? distance : -distance;
}

void Probe::deepen(const Probe& other) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (other.depth[i] <= depth[i]) continue;
    depth[i] = other.depth[i];
    out[i] = other.out[i];
  }
  deepest = static_cast<int>(std::max_element(depth.begin(), depth.end()) - depth.begin());
}

Probe probe(const Patch& patch, const Placement& place, const Solid& other) {
  constexpr double kOnSurface = 1e-9;
  Probe result;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 x = place * patch.p[i];
    const ClosestPoint c = other.bvh.closest(x);
    const bool inside = other.bvh.inside(x);
    result.depth[i] = inside ? c.distance : -c.distance;
    Vec3 out;
    if (c.distance < kOnSurface)
      out = other.normals[c.triangle];
    else
      out = (inside ? c.point - x : x - c.point) / c.distance;
    result.out[i] = place.r.transpose() * out;
    if (result.depth[i] > result.depth[static_cast<std::size_t>(result.deepest)]) result.deepest = static_cast<int>(i);
  }
  return result;
}

Corners moved_by_probe(const Patch& patch, const Probe& probe, double depth) {
  const double worst = std::max(0.0, probe.depth[static_cast<std::size_t>(probe.deepest)]);
  constexpr double kMostAcross = 0.25;
  const double slack = std::max(0.0, depth - worst);
  Corners moved = patch.p;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& out = probe.out[i];
    const double push = std::clamp(probe.depth[i] + 0.5 * slack, 0.0, depth);
    const double across = std::min(std::sqrt(depth * depth - push * push), kMostAcross * depth);
    moved[i] += push * out + across * (patch.inward[i] - patch.inward[i].dot(out) * out);
  }
  return moved;
}

Corners placed(const Placement& place, const Corners& p) { return {place * p[0], place * p[1], place * p[2]}; }

}  // namespace dismantle::verify
