#include "dismantle/geometry/patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "dismantle/geometry/numerics.h"

namespace dismantle::geometry {
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

std::array<Patch, 2> Patch::halves(std::size_t edge, double t) const {
  const std::size_t i = edge, j = (edge + 1) % 3, k = (edge + 2) % 3;
  const Vec3 m = (1 - t) * p[i] + t * p[j], d = (1 - t) * inward[i] + t * inward[j];
  return {Patch{{p[i], m, p[k]}, {inward[i], d, inward[k]}, triangle, halved + 1},
          Patch{{m, p[j], p[k]}, {d, inward[j], inward[k]}, triangle, halved + 1}};
}

Corners moved_by_vertices(const Patch& patch, double depth) {
  return {patch.p[0] + depth * patch.inward[0], patch.p[1] + depth * patch.inward[1],
          patch.p[2] + depth * patch.inward[2]};
}

Corners moved_along(const Patch& patch, const Vec3& direction, double depth) {
  constexpr double kAcross = 0.02;  // sine: keeps corners of neighbours that move alike slightly apart
  static const double along = std::sqrt(1 - kAcross * kAcross);
  Corners moved = patch.p;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 across = patch.inward[i] - patch.inward[i].dot(direction) * direction;
    moved[i] += depth * (along * direction + kAcross * across);
  }
  return moved;
}

Escape escape_at(const Vec3& point, const Solid& solid) {
  const ClosestPoint c = solid.bvh.closest(point);
  // On the surface the difference has no direction. Which side the point is on does not matter, and where surfaces
  // touch along edges no ray tells.
  if (c.distance <= kRounding * point.cwiseAbs().maxCoeff()) return {c.distance, solid.normals[c.triangle]};
  const bool inside = solid.bvh.inside(point);
  return {inside ? c.distance : -c.distance, (inside ? Vec3(c.point - point) : Vec3(point - c.point)) / c.distance};
}

std::optional<Ridge> ridge_on(const Patch& patch, const Probe& probe) {
  if (patch.halved >= 2) return std::nullopt;
  std::optional<Ridge> best;
  double least = 0.7;  // cosine, 45 degrees: corners whose ways out differ less are on one side of a ridge
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double agreement = probe.out[i].dot(probe.out[j]);
    if (agreement >= least || probe.depth[i] <= 0 || probe.depth[j] <= 0) continue;
    // From i to j, the way out of i gets longer by a; from j to i, that of j by b.
    const Vec3 edge = patch.p[j] - patch.p[i];
    const double a = -edge.dot(probe.out[i]), b = edge.dot(probe.out[j]);
    if (!(a + b > 0)) continue;
    const double t = (probe.depth[j] - probe.depth[i] + b) / (a + b);
    if (!(std::abs(t - 0.5) < 0.48)) continue;  // a cut near an end makes a sliver
    least = agreement;
    best = Ridge{i, t};
  }
  return best;
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
  Probe result;
  for (std::size_t i = 0; i < 3; ++i) {
    const Escape at = escape_at(place * patch.p[i], other);
    result.depth[i] = at.depth;
    result.out[i] = place.r.transpose() * at.out;
    if (at.depth > result.depth[static_cast<std::size_t>(result.deepest)]) result.deepest = static_cast<int>(i);
  }
  return result;
}

Corners moved_by_probe(const Patch& patch, const Probe& probe, double depth) {
  const double worst = std::max(0.0, probe.depth[static_cast<std::size_t>(probe.deepest)]);
  const double slack = std::max(0.0, depth - worst);
  Corners moved = patch.p;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& out = probe.out[i];
    const double push = std::clamp(probe.depth[i] + 0.5 * slack, 0.0, depth);
    const double across = std::min(std::sqrt(depth * depth - push * push), 0.25 * depth);
    moved[i] += push * out + across * (patch.inward[i] - patch.inward[i].dot(out) * out);
  }
  return moved;
}

Corners placed(const Placement& place, const Corners& p) { return {place * p[0], place * p[1], place * p[2]}; }

}  // namespace dismantle::geometry
