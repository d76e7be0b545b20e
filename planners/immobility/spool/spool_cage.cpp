#include "spool/spool_cage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "dismantle/immobility/section.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;
using Vec2 = Eigen::Vector2d;

double distance_to(const Vec2& p, const Vec2& a, const Vec2& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + t * (b - a) - p).norm();
}

/// True if the curve, followed in steps of `step` points, stays near its hull: each edge of the hull has a piece of the
/// curve beside it. It is not enough that points are near any edge, since a slit may reach from side to side.
bool keeps_to(const std::vector<Vec2>& points, const std::vector<std::size_t>& hull, std::size_t step,
              double max_dent) {
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const std::size_t end = hull[(k + 1) % hull.size()];
    for (std::size_t i = hull[k]; i != end; i = (i + step) % points.size())
      if (distance_to(points[i], points[hull[k]], points[end]) > max_dent) return false;
  }
  return true;
}

}  // namespace

double convex_reach(const Loop& loop, const Vec3& center, double least, double max_dent) {
  const Vec3 e = loop.plane.normal.unitOrthogonal(), f = loop.plane.normal.cross(e);
  std::vector<Vec2> points;
  for (const Vec3& p : loop.points) points.emplace_back(e.dot(p), f.dot(p));
  const std::vector<std::size_t> hull = loop.hull();
  if (hull.size() < 3) return least;
  double reach = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < hull.size(); ++k)
    reach = std::min(reach,
                     distance_to({e.dot(center), f.dot(center)}, points[hull[k]], points[hull[(k + 1) % hull.size()]]));
  if (!(reach > least)) return least;
  return keeps_to(points, hull, 1, max_dent) || keeps_to(points, hull, points.size() - 1, max_dent) ? reach : least;
}

namespace {

/// Circles about an axis, within the solid, the smallest first.
std::vector<InteriorCircle> circles_about(const Vec3& foot, const Vec3& axis, double lo, double hi, double reach,
                                          const Solid& solid, double depth, const SpoolParameters& params) {
  std::vector<InteriorCircle> circles;
  for (std::int64_t z = 0; z < params.heights; ++z) {
    const double share = (static_cast<double>(z) + 0.5) / static_cast<double>(params.heights);
    InteriorCircle circle{foot + (lo + (hi - lo) * share) * axis, axis, 0};
    for (std::int64_t r = 1; r < params.radii; ++r) {
      circle.radius = reach * static_cast<double>(r) / static_cast<double>(params.radii);
      if (!samples_are_deep(solid, circle, depth)) continue;
      circles.push_back(circle);
      break;
    }
  }
  std::stable_sort(circles.begin(), circles.end(),
                   [](const InteriorCircle& a, const InteriorCircle& b) { return a.radius < b.radius; });
  return circles;
}

/// Sections of the surface across an axis, ascending; only the first ones when told to stop.
std::vector<Loop> loops_across(const Surface& surface, const Vec3& axis, std::int64_t most, const RunContext& context) {
  std::vector<Loop> loops;
  for (const double offset : surface.offsets(axis, static_cast<std::size_t>(most))) {
    if (context.should_stop()) break;
    for (Loop& loop : surface.section({axis, offset})) loops.push_back(std::move(loop));
  }
  return loops;
}

struct Rim {
  double radius = 0;  ///< half of its width
  const Loop* loop = nullptr;
};

/// The widest convex loops around the axis below and above the circle.
std::array<Rim, 2> rims(const std::vector<Loop>& loops, const InteriorCircle& circle, double slack, double max_dent) {
  std::array<Rim, 2> widest;
  const double middle = circle.axis.dot(circle.center);
  for (const Loop& loop : loops) {
    const double offset = loop.plane.offset;
    if (std::abs(offset - middle) < slack || !loop.around(circle.center)) continue;
    Rim& best = widest[offset > middle ? 1 : 0];
    const double reach = convex_reach(loop, circle.center, best.radius, max_dent);
    if (reach > best.radius) best = {reach, &loop};
  }
  return widest;
}

}  // namespace

std::optional<SpoolCage> spool_cage(const Solid& spool, const Solid& around, double allowed, double slack,
                                    double max_dent, const SpoolParameters& params, const RunContext& context) {
  const double depth = allowed + max_dent;  // then the circle does not meet the convex curve beside a rim either
  const auto [center, axes] = symmetry_axes_of(spool);
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
    std::int64_t tried = 0;
    for (InteriorCircle circle : circles_about(foot, axis, lo, hi, reach, around, depth, params)) {
      if (tried++ == params.max_rings) break;
      if (context.should_stop()) return std::nullopt;
      bool deep = false;  // a circle whose samples are deep enough may have to be a little wider
      for (int k = 0; k < 8 && !deep; ++k) {
        deep = is_deep(around, circle, depth);
        if (!deep) circle.radius += reach / static_cast<double>(params.radii);
      }
      if (!deep) continue;
      if (!surface) surface.emplace(spool);
      if (loops.empty()) loops = loops_across(*surface, axis, params.max_sections, context);
      const auto [below, above] = rims(loops, circle, slack, max_dent);
      const double rim = std::min(below.radius, above.radius);
      if (!(rim > circle.radius + slack)) continue;

      for (const Loop& neck : surface->section({axis, axis.dot(circle.center)})) {
        const auto within = [&](const Vec3& p) { return (p - circle.center).norm() < circle.radius; };
        if (!std::all_of(neck.points.begin(), neck.points.end(), within)) continue;
        if (surface->connects(neck, *above.loop, true) && surface->connects(neck, *below.loop, false))
          return SpoolCage{circle, below.loop->plane.offset, above.loop->plane.offset, 2 * rim};
      }
    }
  }
  return std::nullopt;
}

}  // namespace dismantle::immobility
