#include "spool/spool_cage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "dismantle/immobility/section.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;
using std::numbers::pi;

constexpr int kWidenings = 8;           // of a ring about a hole
constexpr std::size_t kSections = 150;  // of the spool
constexpr double kSlack = 1e-6;         // assembly units: a rim is wider by more than that
constexpr double kDent = 1e-4;          // assembly units: rims are so near to convex curves

/// Distance of the point from the convex hull of the curve, if that is more than `least`, and the two are nowhere
/// further than kDent from each other; else `least`.
double reach_of(const Loop& loop, const Vec3& center, double least) {
  const Vec3 e = loop.plane.normal.unitOrthogonal(), f = loop.plane.normal.cross(e);
  const auto in_plane = [&](const Vec3& p) { return Eigen::Vector2d(e.dot(p), f.dot(p)); };
  std::vector<Eigen::Vector2d> hull;
  for (const std::size_t k : loop.hull()) hull.push_back(in_plane(loop.points[k]));
  if (hull.size() < 3) return least;
  const auto distance = [&](const Eigen::Vector2d& p) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < hull.size(); ++k) {
      const Eigen::Vector2d &a = hull[k], along = hull[(k + 1) % hull.size()] - a;
      const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (a + t * along - p).norm());
    }
    return nearest;
  };
  const double reach = distance(in_plane(center));
  if (!(reach > least)) return least;
  for (const Vec3& p : loop.points)
    if (distance(in_plane(p)) > kDent) return least;
  return reach;
}

/// Circles about an axis, within the solid, from the smallest.
std::vector<InnerRing> rings_about(const Vec3& foot, const Vec3& axis, double lo, double hi, double reach,
                                   const Solid& solid, double depth) {
  std::vector<InnerRing> rings;
  for (int z = 0; z < kRingHeights; ++z) {
    InnerRing ring{foot + (lo + (hi - lo) * (z + 0.5) / kRingHeights) * axis, axis, 0};
    for (int r = 1; r < 4 * kRingRadii; ++r) {
      ring.radius = reach * r / (4 * kRingRadii);
      if (!looks_deep(solid, ring, depth)) continue;
      rings.push_back(ring);
      break;
    }
  }
  std::stable_sort(rings.begin(), rings.end(),
                   [](const InnerRing& a, const InnerRing& b) { return a.radius < b.radius; });
  return rings;
}

/// Loops about an axis, ascending; those as far as it came when told to stop.
std::vector<Loop> loops_across(const Surface& surface, const Vec3& axis, const RunContext& context) {
  std::vector<Loop> loops;
  for (const double offset : surface.offsets(axis, kSections)) {
    if (context.should_stop()) break;
    for (Loop& loop : surface.section({axis, offset})) loops.push_back(std::move(loop));
  }
  return loops;
}

struct Rim {
  double radius = 0;  ///< half of its width
  const Loop* loop = nullptr;
};

/// The widest convex loops around the axis below and above the ring.
std::array<Rim, 2> rims(const std::vector<Loop>& loops, const InnerRing& ring) {
  std::array<Rim, 2> widest;
  const double middle = ring.axis.dot(ring.center);
  for (const Loop& loop : loops) {
    const double offset = loop.plane.offset;
    if (std::abs(offset - middle) < 1e-6 || !loop.around(ring.center)) continue;
    Rim& best = widest[offset > middle ? 1 : 0];
    const double reach = reach_of(loop, ring.center, best.radius);
    if (reach > best.radius) best = {reach, &loop};
  }
  return widest;
}

}  // namespace

std::optional<SpoolCage> spool_cage(const Solid& spool, const Solid& around, double allowed, std::size_t most_rings,
                                    const RunContext& context) {
  const double depth = allowed + kDent;  // so that it also keeps out of the convex curve beside a rim
  const auto [center, axes] = round_axes_of(spool);
  const Vec3 foot = spool.frame * center;
  std::optional<Surface> surface;
  for (const Vec3& local : axes) {
    const Vec3 axis = spool.frame.q * local;
    double lo = 0, hi = 0, reach = 0;
    for (const Vec3& v : spool.mesh.vertices) {
      const Vec3 d = spool.frame * v - foot;
      lo = std::min(lo, axis.dot(d));
      hi = std::max(hi, axis.dot(d));
      reach = std::max(reach, (d - axis.dot(d) * axis).norm());
    }
    std::vector<Loop> loops;
    std::size_t tried = 0;
    for (InnerRing ring : rings_about(foot, axis, lo, hi, reach, around, depth)) {
      if (tried++ == most_rings) break;
      if (context.should_stop()) return std::nullopt;
      bool deep = false;  // what looked so at a glance may have to be a little wider
      for (int k = 0; k < kWidenings && !deep; ++k) {
        deep = is_deep(around, ring, depth, 0, 2 * pi, kArcHalvings);
        if (!deep) ring.radius += reach / (4 * kRingRadii);
      }
      if (!deep) continue;
      if (!surface) surface.emplace(spool);
      if (loops.empty()) loops = loops_across(*surface, axis, context);
      const auto [below, above] = rims(loops, ring);
      const double rim = std::min(below.radius, above.radius);
      if (!(rim > ring.radius + kSlack)) continue;
      for (const Loop& neck : surface->section({axis, axis.dot(ring.center)})) {
        const auto within = [&](const Vec3& p) { return (p - ring.center).norm() < ring.radius; };
        if (!std::all_of(neck.points.begin(), neck.points.end(), within)) continue;
        if (surface->connects(neck, *above.loop, true) && surface->connects(neck, *below.loop, false))
          return SpoolCage{ring, 2 * rim};
      }
    }
  }
  return std::nullopt;
}

}  // namespace dismantle::immobility
