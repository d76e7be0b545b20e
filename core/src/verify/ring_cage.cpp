#include "verify/ring_cage.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "verify/patch.h"
#include "verify/section.h"

namespace dismantle::verify {
namespace {

using Vec3 = Eigen::Vector3d;
using std::numbers::pi;

constexpr int kHeights = 24, kRadii = 32;  // where rings are looked for
constexpr int kGlance = 24;                // points at which a ring is looked at first
constexpr int kHalvings = 12;              // of arcs, to prove that all of them is deep enough
constexpr std::size_t kSections = 400;     // of the solid around it
constexpr double kSlack = 1e-6;            // assembly units: an opening is smaller by more than that

Vec3 on(const InnerRing& ring, double angle) {
  const Vec3 e = ring.axis.unitOrthogonal(), f = ring.axis.cross(e);
  return ring.center + ring.radius * (std::cos(angle) * e + std::sin(angle) * f);
}

/// Is all of the arc deeper than that? Depths change no faster than the point moves.
bool is_deep(const Solid& solid, const InnerRing& ring, double depth, double from, double to, int halvings) {
  const double middle = 0.5 * (from + to), d = escape_at(solid.frame.inverse() * on(ring, middle), solid).depth;
  if (d > depth + 0.5 * (to - from) * ring.radius) return true;
  if (!(d > depth) || halvings == 0) return false;
  return is_deep(solid, ring, depth, from, middle, halvings - 1) &&
         is_deep(solid, ring, depth, middle, to, halvings - 1);
}

bool looks_deep(const Solid& solid, const InnerRing& ring, double depth) {
  for (int k = 0; k < kGlance; ++k)
    if (!(escape_at(solid.frame.inverse() * on(ring, 2 * pi * ((5 * k) % kGlance) / kGlance), solid).depth > depth))
      return false;
  return true;
}

/// Axes of inertia of the surface, and its centre.
std::pair<Vec3, Eigen::Matrix3d> axes_of(const Mesh& mesh) {
  double area = 0;
  Vec3 center = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.vertex(t, 0), b = mesh.vertex(t, 1), c = mesh.vertex(t, 2);
    const double w = (b - a).cross(c - a).norm();
    const Vec3 m = (a + b + c) / 3;
    area += w;
    center += w * m;
    for (const Vec3& p : {Vec3(0.5 * (a + b)), Vec3(0.5 * (b + c)), Vec3(0.5 * (c + a))})
      second += w / 3 * p * p.transpose();
  }
  center /= area;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(second / area - center * center.transpose());
  return {center, axes.eigenvectors()};
}

}  // namespace

std::vector<InnerRing> rings_in(const Solid& solid, double depth, std::size_t most) {
  std::vector<InnerRing> candidates;
  if (!(0.5 * solid.box.size().minCoeff() > depth)) return candidates;
  const auto [center, axes] = axes_of(solid.mesh);
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = axes.col(k);
    double lo = 0, hi = 0, reach = 0;
    for (const Vec3& v : solid.mesh.vertices) {
      const double h = axis.dot(v - center);
      lo = std::min(lo, h);
      hi = std::max(hi, h);
      reach = std::max(reach, (v - center - h * axis).norm());
    }
    for (int z = 0; z < kHeights; ++z) {
      InnerRing ring{solid.frame * (center + (lo + (hi - lo) * (z + 0.5) / kHeights) * axis), solid.frame.q * axis, 0};
      for (int r = kRadii; r > 0; --r) {
        ring.radius = reach * r / kRadii;
        if (!looks_deep(solid, ring, depth)) continue;
        candidates.push_back(ring);
        break;
      }
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const InnerRing& a, const InnerRing& b) { return a.radius > b.radius; });
  std::vector<InnerRing> rings;
  for (const InnerRing& ring : candidates) {
    if (rings.size() == most) break;
    if (is_deep(solid, ring, depth, 0, 2 * pi, kHalvings)) rings.push_back(ring);
  }
  return rings;
}

std::optional<RingCage> ring_cage(const InnerRing& ring, const Solid& around) {
  const Surface surface(around);
  const double middle = ring.axis.dot(ring.center);
  const std::vector<double> heights = surface.heights(ring.axis, 1e-6);
  std::array<std::optional<Loop>, 2> nearest;  // the smallest loop around the axis below and above the ring
  const std::size_t step = 1 + heights.size() / kSections;
  for (std::size_t k = 0; k + step < heights.size(); k += step) {
    const double offset = 0.5 * (heights[k] + heights[k + 1]);
    if (std::abs(offset - middle) < 1e-9) continue;
    auto& best = nearest[offset > middle ? 1 : 0];
    for (Loop& loop : surface.section({ring.axis, offset})) {
      if (!(loop.diameter < 2 * ring.radius - kSlack) || (best && best->diameter <= loop.diameter)) continue;
      if (loop.around(ring.center)) best = std::move(loop);
    }
  }
  std::vector<Loop> loops;
  for (auto& loop : nearest)
    if (loop) loops.push_back(std::move(*loop));
  if (loops.empty()) return std::nullopt;
  const auto chamber = surface.closed_by(loops, ring.center);
  if (!chamber || chamber->inside(on(ring, 1)) != true) return std::nullopt;
  RingCage cage{ring, 0};
  for (const Loop* loop : chamber->loops()) cage.opening = std::max(cage.opening, loop->diameter);
  return cage;
}

}  // namespace dismantle::verify
