#include "disc/diameter_clearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace dismantle::immobility {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using std::numbers::pi;

// Cosine of the angle between a line and a normal below which the line counts as parallel to the plane.
constexpr double kParallel = 1e-6;

double along(const Aabb& box, const Vec3& axis) { return 0.5 * axis.cwiseAbs().dot(box.size()); }

}  // namespace

/// Directions in a plane, between two angles less than pi / 2 apart.
struct DiameterClearance::Lines {
  Vec3 normal, e, f;
  double from, to;

  Vec3 at(double angle) const { return std::cos(angle) * e + std::sin(angle) * f; }
  double middle() const { return 0.5 * (from + to); }
};

DiameterClearance::DiameterClearance(const Facets& facets, double radius, double half, double slack)
    : facets_(facets), slack_(slack), radius_(radius - slack), near_(half - slack) {}

std::vector<std::uint32_t> DiameterClearance::around(const Aabb& box, double reach,
                                                     const std::vector<std::uint32_t>& of) const {
  Aabb wide = box;
  wide.inflate(reach + slack_);
  const Vec3 center = box.center();
  std::vector<std::uint32_t> found;
  for (const std::uint32_t f : of) {
    if (!facets_[f].box.overlaps(wide)) continue;
    const FacetPlane& p = facets_.plane_of(f);
    if (std::abs(p.normal.dot(center) - p.offset) <= along(box, p.normal) + reach + slack_) found.push_back(f);
  }
  return found;
}

bool DiameterClearance::all_near(const Aabb& box, const std::vector<std::uint32_t>& around) {
  std::vector<std::uint32_t> tried;
  std::vector<Vec2> points(8);
  const Vec3 center = box.center();
  for (const std::uint32_t f : around) {
    const std::uint32_t number = facets_[f].plane;
    const FacetPlane& p = facets_.planes()[number];
    const double off = std::abs(p.normal.dot(center) - p.offset) + along(box, p.normal);
    if (!(off < near_) || std::find(tried.begin(), tried.end(), number) != tried.end()) continue;
    tried.push_back(number);
    work_ += p.facets.size();
    for (int k = 0; k < 8; ++k) points[k] = p.flat(corner(box, k));
    if (facets_.covers(number, points, std::sqrt(near_ * near_ - off * off))) return true;
  }
  return false;
}

/// The segments in which facets cross a plane through a point, relative to the point.
std::vector<DiameterClearance::Wall> DiameterClearance::walls(const Vec3& from, const Vec3& normal,
                                                              const std::vector<std::uint32_t>& around) {
  const Vec3 e = normal.unitOrthogonal(), f = normal.cross(e);
  std::vector<Wall> walls;
  work_ += around.size();
  for (const std::uint32_t id : around) {
    const Outline& outline = facets_[id].outline;
    const FacetPlane& p = facets_.plane_of(id);
    std::array<Vec2, 2> ends;
    std::size_t count = 0;
    const auto seen = [&](const Vec3& x) { return Vec2(e.dot(x - from), f.dot(x - from)); };
    Vec3 x = p.point(outline.back());
    double s = normal.dot(x - from);
    for (const Vec2& q : outline) {
      const Vec3 y = p.point(q);
      const double t = normal.dot(y - from);
      if ((s <= 0) != (t <= 0) && count++ < 2) ends[count - 1] = seen(x + s / (s - t) * (y - x));
      x = y;
      s = t;
    }
    if (count != 2) continue;
    // The thick disc also hits the wall when its middle line passes close to the end of it.
    const Vec2 beyond = 0.9 * near_ * (ends[1] - ends[0]).stableNormalized();
    walls.push_back({ends[0] - beyond, ends[1] + beyond});
  }
  return walls;
}

double DiameterClearance::free_half_length(const Vec3& from, const Vec3& normal,
                                           const std::vector<std::uint32_t>& around) {
  const std::vector<Wall> all = walls(from, normal, around);
  double longest = 0;
  constexpr int kSamples = 32;  // a narrower fan of free lines is found by no_diameter_fits(), which then fails
  for (int k = 0; k < kSamples; ++k) {
    const double angle = free_ + pi * k / kSamples;  // the direction that was free last comes first
    const Vec2 d(std::cos(angle), std::sin(angle)), left(-d.y(), d.x());
    double room = std::numeric_limits<double>::infinity();
    for (const Wall& w : all) {
      const double s = left.dot(w.a), t = left.dot(w.b);
      if ((s <= 0) != (t <= 0)) room = std::min(room, std::abs(d.dot(w.a + s / (s - t) * (w.b - w.a))));
    }
    longest = std::max(longest, room);
    if (room < radius_) continue;
    free_ = angle;
    break;
  }
  return longest;
}

/// Intersections of a plane with the outer lines through the corners of the box. False: some lines do not meet it
/// within the radius, or not from the same side.
///
/// For a fixed c, the intersection of the line from c along d with the plane is a central projection of d, which keeps
/// betweenness while d stays on one side of the plane. For a fixed d it is linear in c. So the intersections of all
/// lines are in the convex hull of `points`. The same holds for the distances along the lines.
bool DiameterClearance::intersect(const FacetPlane& plane, const Aabb& box, const Lines& lines, double least,
                                  double most, std::vector<Vec2>& points) const {
  points.clear();
  double side = 0;
  for (const double angle : {lines.from, lines.to}) {
    const Vec3 d = lines.at(angle);
    const double steep = plane.normal.dot(d);
    if (std::abs(steep) < kParallel || steep * side < 0) return false;
    side = steep;
    for (int k = 0; k < 8; ++k) {
      const Vec3 c = corner(box, k);
      const double distance = (plane.offset - plane.normal.dot(c)) / steep;
      if (!(distance >= least && distance <= most)) return false;
      points.push_back(plane.flat(c + distance * d));
    }
  }
  return true;
}

/// True if all lines meet facets in that plane, within the radius.
bool DiameterClearance::blocks(std::uint32_t number, const Aabb& box, const Lines& lines) {
  const FacetPlane& plane = facets_.planes()[number];
  if (!intersect(plane, box, lines, -radius_, radius_, points_)) return false;
  work_ += plane.facets.size();
  return facets_.covers(number, points_, near_);
}

/// True if each line meets a facet in one of those planes, within the radius, forward (`side` 1) or backward (-1).
///
/// The box is behind all of the planes, and all lines lead towards all of them. Where a line passes its first plane, it
/// is still behind the others. So only the part of each plane that is behind the others must be covered.
bool DiameterClearance::blocks(const std::vector<std::uint32_t>& planes, double side, const Aabb& box,
                               const Lines& lines) {
  const Vec3 d = side * lines.at(lines.middle());
  std::vector<Facets::Behind> behind;
  for (const std::uint32_t p : planes) behind.push_back({p, facets_.planes()[p].normal.dot(d) > 0 ? 1.0 : -1.0});
  for (const std::uint32_t p : planes) {
    const FacetPlane& plane = facets_.planes()[p];
    if (!intersect(plane, box, lines, side > 0 ? 0 : -radius_, side > 0 ? radius_ : 0, points_)) return false;
    work_ += plane.facets.size();
    if (!facets_.covers_behind(p, points_, behind, near_)) return false;
  }
  return true;
}

bool DiameterClearance::no_diameter_fits(const Aabb& box, const Vec3& normal,
                                         const std::vector<std::uint32_t>& around) {
  const Vec3 e = normal.unitOrthogonal();
  Lines lines{normal, e, normal.cross(e), 0, 0};
  steps_ = shown_ = 0;
  constexpr int kFans = 4;  // of directions; less than pi / 2 each
  for (int k = 0; k < kFans; ++k) {
    lines.from = pi * k / kFans;
    lines.to = pi * (k + 1) / kFans;
    if (!all_blocked(box, lines, around, 1.0 / kFans)) return false;
  }
  return true;
}

bool DiameterClearance::all_blocked(const Aabb& box, const Lines& lines, const std::vector<std::uint32_t>& around,
                                    double share) {
  // Gives up after 64 subproblems when the proved share predicts more than 2000 of them.
  if (++steps_ > 64 && steps_ > 2000 * shown_) return false;
  const Vec3 center = box.center(), d = lines.at(lines.middle()), across = lines.normal.cross(d);
  const double spread = radius_ * std::sin(0.5 * (lines.to - lines.from));
  const double up = along(box, lines.normal) + near_, wide = along(box, across) + spread + near_;
  const double far = along(box, d) + radius_ + near_;
  // Facets that some of the lines may meet; the planes of those that the middle line meets; and the first planes that
  // the middle and the outer lines meet, forward and backward.
  std::vector<std::uint32_t> met, planes;
  struct Hit {
    double along;
    std::uint32_t plane;
  };
  const Vec3 sight[3] = {lines.at(lines.from), d, lines.at(lines.to)};
  std::array<std::array<Hit, 3>, 2> first;
  for (auto& hits : first) hits.fill({radius_, 0});
  double nearest = radius_;
  for (const std::uint32_t id : around) {
    const Facet& facet = facets_[id];
    const FacetPlane& p = facets_.plane_of(id);
    const Vec3 middle = facet.box.center() - center;
    const auto apart = [&](const Vec3& axis, double reach) {
      return std::abs(axis.dot(middle)) > reach + along(facet.box, axis);
    };
    if (apart(lines.normal, up) || apart(across, wide) || apart(d, far)) continue;
    met.push_back(id);
    const double off = p.offset - p.normal.dot(center);
    for (int k = 0; k < 3; ++k) {
      const double steep = p.normal.dot(sight[k]);
      if (!(std::abs(off) <= radius_ * std::abs(steep)) || std::abs(steep) < kParallel) continue;
      const double along = off / steep;
      Hit& hit = first[along < 0 ? 1 : 0][k];
      if (k != 1 && !(std::abs(along) < hit.along)) continue;
      if (!facet.within(p.flat(center + along * sight[k]), near_)) continue;
      if (std::abs(along) < hit.along) hit = {std::abs(along), facet.plane};
      if (k == 1 && std::find(planes.begin(), planes.end(), facet.plane) == planes.end()) planes.push_back(facet.plane);
    }
  }
  for (const auto& hits : first) nearest = std::min(nearest, hits[1].along);
  work_ += around.size();
  if (planes.empty()) return false;
  for (const std::uint32_t p : planes)
    if (blocks(p, box, lines)) {
      shown_ += share;
      return true;
    }
  for (const int back : {0, 1}) {
    std::vector<std::uint32_t> corner_of;
    for (const Hit& hit : first[back])
      if (hit.along < radius_ && std::find(corner_of.begin(), corner_of.end(), hit.plane) == corner_of.end())
        corner_of.push_back(hit.plane);
    if (corner_of.size() > 1 && blocks(corner_of, back ? -1 : 1, box, lines)) {
      shown_ += share;
      return true;
    }
  }
  // Halves the directions or the positions, whichever moves the points of intersection further.
  const Vec3 moves = box.size().cwiseProduct((Vec3::Ones() - d.cwiseAbs2()).cwiseMax(0).cwiseSqrt());
  int axis = 0;
  if (moves.maxCoeff(&axis) > nearest * (lines.to - lines.from)) {
    Aabb below = box, above = box;
    below.hi[axis] = above.lo[axis] = center[axis];
    for (const Aabb& half : {below, above}) {
      if (all_near(half, met))
        shown_ += 0.5 * share;
      else if (!all_blocked(half, lines, met, 0.5 * share))
        return false;
    }
    return true;
  }
  if (lines.to - lines.from < 1e-3) return false;  // rad; ends of diameters differ by a thousandth of the radius
  Lines low = lines, high = lines;
  low.to = high.from = lines.middle();
  return all_blocked(box, low, met, 0.5 * share) && all_blocked(box, high, met, 0.5 * share);
}

}  // namespace dismantle::immobility
