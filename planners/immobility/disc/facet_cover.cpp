#include <algorithm>

#include "disc/facets.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle::immobility {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

bool all_near(const Facet& facet, const std::vector<Vec2>& points, double near) {
  return std::all_of(points.begin(), points.end(), [&](const Vec2& p) { return facet.within(p, near); });
}

}  // namespace

bool Facets::covers(std::uint32_t number, const std::vector<Vec2>& points, double near) const {
  const FacetPlane& plane = planes_[number];
  Aabb box = flat_box(points);
  box.inflate(near);
  std::size_t touched = 0;
  for (const std::uint32_t f : plane.facets) {
    if (!facets_[f].flat.overlaps(box)) continue;
    ++touched;
    if (all_near(facets_[f], points, near)) return true;
  }
  if (touched < 2) return false;
  const Outline hull = hull_of(points);
  int left = 64;  // pieces into which the hull is cut: time is bounded, and a hull over more facets is divided anyway
  return hull.size() > 2 && covers(plane, hull, near, left);
}

bool Facets::covers_behind(std::uint32_t number, const std::vector<Vec2>& points, const std::vector<Behind>& others,
                           double near) const {
  const FacetPlane& plane = planes_[number];
  Outline hull = hull_of(points);
  if (hull.size() < 3) return false;
  for (const Behind& other : others) {
    if (other.plane == number) continue;
    const FacetPlane& o = planes_[other.plane];
    const Vec3 normal = other.side * o.normal;
    const Vec2 slope = plane.flat(normal);  // the height above the other plane is linear, with this slope
    const double length = slope.norm(),
                 height = other.side * o.offset - plane.offset * plane.normal.dot(normal) + 0.1 * slack_;
    if (length < 1e-6) continue;  // the planes are parallel, so the other one does not cut the hull
    hull = cut(hull, height / (length * length) * slope, {slope.y(), -slope.x()}).second;
    if (hull.size() < 3) return true;
  }
  return covers(number, hull, near);
}

bool Facets::covers(const FacetPlane& plane, const Outline& piece, double near, int& left) const {
  if (--left < 0) return false;
  const Aabb box = flat_box(piece);
  const Facet* over = nullptr;
  double most = kRounding * box.size().squaredNorm();  // an overlap of less area is rounding
  for (const std::uint32_t f : plane.facets) {
    Aabb around = facets_[f].flat;
    around.inflate(near);
    if (!around.overlaps(box)) continue;
    const Outline& outline = facets_[f].outline;
    if (all_near(facets_[f], piece, near)) return true;
    Outline common = piece;
    for (std::size_t k = 0; k < outline.size() && !common.empty(); ++k)
      common = cut(common, outline[k], outline[(k + 1) % outline.size()] - outline[k]).first;
    if (const double shared = area(common); shared > most) {
      most = shared;
      over = &facets_[f];
    }
  }
  if (!over) return false;
  Outline rest = piece;
  for (std::size_t k = 0; k < over->outline.size(); ++k) {
    auto [in, out] = cut(rest, over->outline[k], over->outline[(k + 1) % over->outline.size()] - over->outline[k]);
    if (out.size() > 2 && !covers(plane, out, near, left)) return false;
    rest = std::move(in);
  }
  return true;
}

}  // namespace dismantle::immobility
