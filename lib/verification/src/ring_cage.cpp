#include "ring_cage.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "patch.h"
#include "section.h"

namespace dismantle::verify {
namespace {

using Vec3 = Eigen::Vector3d;
using std::numbers::pi;

constexpr int kHeights = 24, kRadii = 32;  // where rings are looked for
constexpr int kGlance = 24;                // points at which a ring is looked at first
constexpr int kWidenings = 8;              // of a ring about a hole
constexpr int kHalvings = 12;              // of arcs, to prove that all of them is deep enough
constexpr std::size_t kSections = 150;     // of the solid around it
constexpr double kSlack = 1e-6;            // assembly units: an opening is smaller by more than that
constexpr double kParallel = 0.999999;     // cosine of the angle between directions that are the same
constexpr std::size_t kFaces = 300;        // directions of faces that are told apart
constexpr double kDent = 1e-4;             // assembly units: rims are so near to convex curves

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

/// Directions about which the solid may be round: its axes of inertia, and across its largest flat faces. Its frame.
struct Axes {
  Vec3 center = Vec3::Zero();  ///< of the surface
  std::vector<Vec3> all;
};

Axes axes_of(const Solid& solid) {
  const Mesh& mesh = solid.mesh;
  double area = 0;
  Axes axes;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  std::vector<std::pair<double, Vec3>> faces;  // by direction
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.vertex(t, 0), b = mesh.vertex(t, 1), c = mesh.vertex(t, 2);
    const double w = (b - a).cross(c - a).norm();
    area += w;
    axes.center += w * (a + b + c) / 3;
    for (const Vec3& p : {Vec3(0.5 * (a + b)), Vec3(0.5 * (b + c)), Vec3(0.5 * (c + a))})
      second += w / 3 * p * p.transpose();
    const auto same = std::find_if(faces.begin(), faces.end(),
                                   [&](const auto& f) { return std::abs(f.second.dot(solid.normals[t])) > kParallel; });
    if (same != faces.end())
      same->first += w;
    else if (faces.size() < kFaces)
      faces.emplace_back(w, solid.normals[t]);
  }
  axes.center /= area;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> inertia(second / area - axes.center * axes.center.transpose());
  for (int k = 0; k < 3; ++k) axes.all.push_back(inertia.eigenvectors().col(k));
  std::stable_sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [w, normal] : faces) {
    if (axes.all.size() == 6 || w < 0.02 * area) break;
    if (std::none_of(axes.all.begin(), axes.all.end(),
                     [n = normal](const Vec3& known) { return std::abs(known.dot(n)) > kParallel; }))
      axes.all.push_back(normal);
  }
  return axes;
}

}  // namespace

std::vector<InnerRing> rings_in(const Solid& solid, double depth, std::size_t most) {
  std::vector<InnerRing> candidates;
  if (!(0.5 * solid.box.size().minCoeff() > depth)) return candidates;
  const auto [center, axes] = axes_of(solid);
  for (const Vec3& axis : axes) {
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

std::optional<RingCage> ring_cage(const InnerRing& ring, const Solid& around, const RunContext& context) {
  if (!around.box.contains(around.frame.inverse() * ring.center)) return std::nullopt;  // a chamber is in the hull
  const Surface surface(around);
  const double middle = ring.axis.dot(ring.center);
  std::array<std::pair<double, Loop>, 2> nearest;  // the smallest around the axis below and above the ring: width, loop
  for (auto& [width, loop] : nearest) width = 2 * ring.radius - kSlack;
  for (const double offset : surface.offsets(ring.axis, kSections)) {
    if (context.should_stop()) return std::nullopt;
    if (std::abs(offset - middle) < 1e-9) continue;
    auto& best = nearest[offset > middle ? 1 : 0];
    for (Loop& loop : surface.section({ring.axis, offset})) {
      if (!loop.around(ring.center)) continue;
      if (const double width = loop.diameter(); width < best.first) best = {width, std::move(loop)};
    }
  }
  std::vector<Loop> loops;
  for (auto& [width, loop] : nearest)
    if (!loop.points.empty()) loops.push_back(std::move(loop));
  if (loops.empty()) return std::nullopt;
  const auto chamber = surface.closed_by(loops, ring.center);
  if (!chamber || chamber->inside(on(ring, 1)) != true) return std::nullopt;
  RingCage cage{ring, 0};
  for (const Loop* loop : chamber->loops()) cage.opening = std::max(cage.opening, loop->diameter());
  return cage;
}

namespace {

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
  for (int z = 0; z < kHeights; ++z) {
    InnerRing ring{foot + (lo + (hi - lo) * (z + 0.5) / kHeights) * axis, axis, 0};
    for (int r = 1; r < 4 * kRadii; ++r) {
      ring.radius = reach * r / (4 * kRadii);
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

std::optional<SpoolCage> spool_cage(const Solid& spool, const Solid& around, double allowed,
                                    const RunContext& context) {
  constexpr std::size_t kRings = 4;
  const double depth = allowed + kDent;  // so that it also keeps out of the convex curve beside a rim
  const auto [center, axes] = axes_of(spool);
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
      if (tried++ == kRings) break;
      if (context.should_stop()) return std::nullopt;
      bool deep = false;  // what looked so at a glance may have to be a little wider
      for (int k = 0; k < kWidenings && !deep; ++k) {
        deep = is_deep(around, ring, depth, 0, 2 * pi, kHalvings);
        if (!deep) ring.radius += reach / (4 * kRadii);
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

}  // namespace dismantle::verify
