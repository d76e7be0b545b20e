#include "dismantle/verification/contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "contact/round_axis.h"
#include "contact/survey.h"
#include "depth_body.h"
#include "dismantle/geometry/patch.h"
#include "dismantle/geometry/sweep.h"

namespace dismantle {
namespace verify {
namespace {

using Vec3 = Eigen::Vector3d;

/// Depths up to this are rounding of coordinates: a measured depth is exact to one tolerance.
double rounding_of(double tolerance) { return 2 * tolerance; }

Aabb common_box(const Aabb& a, const Aabb& b) { return {a.lo.cwiseMax(b.lo), a.hi.cwiseMin(b.hi)}; }

double smaller_diagonal(const Field& a, const Field& b) {
  return std::min(a.box().size().norm(), b.box().size().norm());
}

/// Calls f(point, normal) for all vertices (with normal zero) and triangle centres until it returns false.
template <class F>
bool all_points(const Field& a, const F& f) {
  for (std::size_t k = 0; k < a.solids().size(); ++k) {
    const Solid& s = a.solids()[k];
    const Placement& place = a.to_world()[k];
    for (const Vec3& v : s.mesh.vertices)
      if (!f(place * v, Vec3::Zero().eval())) return false;
    for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t)
      if (!f(place * ((s.mesh.vertex(t, 0) + s.mesh.vertex(t, 1) + s.mesh.vertex(t, 2)) / 3), place.r * s.normals[t]))
        return false;
  }
  return true;
}

bool covered(const Field& a, const Field& b, double distance) {
  return all_points(a, [&](const Vec3& p, const Vec3& normal) {
    const Field::Seen seen = b.at(p, 2 * distance);
    return std::abs(seen.depth) <= distance && normal.dot(seen.normal) >= 0;
  });
}

bool coincident(const Field& a, const Field& b, double tolerance) {
  // Copies of a part that were converted with different precision differ by up to about 0.1 % of their size.
  const double distance = std::max(rounding_of(tolerance), 1e-3 * smaller_diagonal(a, b));
  const auto apart = [](const Vec3& x, const Vec3& y) { return (x - y).cwiseAbs().maxCoeff(); };
  if (std::max(apart(a.box().lo, b.box().lo), apart(a.box().hi, b.box().hi)) > distance) return false;
  return covered(a, b, distance) && covered(b, a, distance);
}

bool lies_in(const Field& inner, const Field& outer, double tolerance) {
  Aabb around = outer.box();
  around.inflate(rounding_of(tolerance));
  if (!around.contains(inner.box().lo) || !around.contains(inner.box().hi)) return false;
  return all_points(inner, [&](const Vec3& p, const Vec3&) {
    return outer.at(p, 2 * rounding_of(tolerance)).depth >= -rounding_of(tolerance);
  });
}

/// Sums over the cells of both surfaces near each other.
struct Overlap {
  double near_area = 0, area = 0, depth_area = 0;  ///< of facing cells; depth_area: integral of the depth
  Aabb region;
  std::vector<Vec3> corners;  ///< of the cells in it
  std::vector<FittedPlace> deep;

  void add(const std::vector<SurfaceCell>& cells, double reach, double depth, double tolerance, double sign) {
    for (const SurfaceCell& c : cells) {
      if (c.seen.depth > tolerance)
        for (const Vec3& p : c.p) {
          region.extend(p);
          corners.push_back(p);
        }
      if (!c.faces() || c.seen.depth < -reach) continue;
      near_area += c.area;
      if (c.seen.depth <= tolerance) continue;
      area += c.area;
      depth_area += c.area * c.seen.depth;
      if (c.seen.depth >= 0.5 * depth) deep.push_back({c.middle(), sign * c.normal, c.area});
    }
  }
};

/// The box around all that the points pass when they turn about the axis. A thread overlaps its bore on a helix, which
/// covers the rim of the bore at one place: a box of it depends on how the parts lie, and that of its turns does not.
Aabb box_of_ring(const std::vector<Vec3>& points, const RoundAxis& axis) {
  double low = std::numeric_limits<double>::infinity(), high = -low, radius = 0;
  for (const Vec3& p : points) {
    const double along = axis.direction.dot(p - axis.point);
    low = std::min(low, along);
    high = std::max(high, along);
    radius = std::max(radius, (p - axis.point - along * axis.direction).norm());
  }
  const Vec3 reach = radius * (Vec3::Ones() - axis.direction.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  Aabb box;
  for (const double along : {low, high})
    for (const double sign : {1.0, -1.0}) box.extend(axis.point + along * axis.direction + sign * reach);
  return box;
}

OverlapPlace place_of(const Field& a, const Field& b, const Penetration& deepest, double tolerance) {
  // Surfaces are near within 4 depths, or 2 % of the smaller part's diagonal. An overlap whose depth grows from 0, as
  // of a ball or a roller, then covers less than half of the near surfaces.
  const double reach = std::max(4 * deepest.depth, 0.02 * smaller_diagonal(a, b));
  const double finest = std::max(0.5 * deepest.depth, tolerance);
  Overlap sum;
  sum.add(survey(a, b, reach, finest), reach, deepest.depth, tolerance, 1);
  sum.add(survey(b, a, reach, finest), reach, deepest.depth, tolerance, -1);
  OverlapPlace place;
  place.at = deepest.point;
  const auto axis = round_axis(sum.deep);
  if (axis && !sum.corners.empty()) sum.region = box_of_ring(sum.corners, *axis);
  // Cells at the border reach out of the overlap, but no part of the overlap is outside either box.
  if (!sum.region.empty()) place.region = common_box(sum.region, common_box(a.box(), b.box()));
  place.region.extend(deepest.point);
  place.share = sum.near_area > 0 ? sum.area / sum.near_area : 0;
  if (axis) {
    place.axis = axis->direction;
    place.axis_point = axis->point;
  }
  // A uniform overlap covers at least half of the near surfaces, with a mean depth of at least half the greatest.
  const bool whole = place.share >= 0.5 && sum.depth_area >= 0.5 * deepest.depth * sum.area;
  place.contact = place.axis || whole ? ContactClass::uniform_interference : ContactClass::local_interference;
  return place;
}

/// Some triangle of `a` comes within `distance` of `b`.
bool within(const Field& a, const Field& b, double distance) {
  for (std::size_t i = 0; i < a.solids().size(); ++i)
    for (std::size_t k = 0; k < b.solids().size(); ++k) {
      const Solid &x = a.solids()[i], &y = b.solids()[k];
      const Placement place(y.frame.inverse() * x.frame);
      Aabb around = y.box;
      around.inflate(distance);
      for (std::uint32_t t = 0; t < x.mesh.triangles.size(); ++t) {
        const Corners c = placed(place, x.bvh.corners(t));
        Aabb box;
        for (const Vec3& p : c) box.extend(p);
        if (box.overlaps(around) && Sweep(c, c, distance).test(y.bvh) == SweepResult::unclear) return true;
      }
    }
  return false;
}

OverlapPlace place_of_duplicate(const Field& a, const Field& b) {
  const Aabb common = common_box(a.box(), b.box());
  return {ContactClass::duplicate, common.center(), common, 1};
}

PairContact of_overlap(const Field& a, const Field& b, const Penetration& deepest, double tolerance) {
  PairContact found;
  found.depth = deepest.depth;
  if (coincident(a, b, tolerance)) {
    found.place = place_of_duplicate(a, b);
    return found;
  }
  const bool first = lies_in(a, b, tolerance);
  if (first || lies_in(b, a, tolerance)) {
    found.place.at = deepest.point;
    found.place.contact = ContactClass::inside;
    found.place.region = first ? a.box() : b.box();
    found.place.share = 1;
    found.first_inside = first;
  } else {
    found.place = place_of(a, b, deepest, tolerance);
  }
  return found;
}

}  // namespace
}  // namespace verify

PairContact classify_overlap(const DepthBody& a, const DepthBody& b, const Penetration& deepest, double tolerance) {
  if (!(tolerance > 0)) throw std::invalid_argument("classify_overlap: tolerance must be > 0");
  return verify::of_overlap(verify::Field(a.impl().solids), verify::Field(b.impl().solids), deepest, tolerance);
}

std::optional<ContactClass> classify_apart(const DepthBody& a, const DepthBody& b, double tolerance, double near) {
  if (!(tolerance > 0)) throw std::invalid_argument("classify_apart: tolerance must be > 0");
  const verify::Field x(a.impl().solids), y(b.impl().solids);
  if (verify::coincident(x, y, tolerance)) return ContactClass::duplicate;
  if (verify::within(x, y, verify::rounding_of(tolerance))) return ContactClass::kissing;
  if (verify::within(x, y, near)) return ContactClass::clearance;
  return std::nullopt;
}

std::optional<PairContact> classify_contact(const DepthBody& a, const DepthBody& b, double tolerance, double near) {
  if (!(tolerance > 0)) throw std::invalid_argument("classify_contact: tolerance must be > 0");
  const verify::Field x(a.impl().solids), y(b.impl().solids);
  Aabb around = x.box();
  around.inflate(near);
  if (!around.overlaps(y.box())) return std::nullopt;
  PairContact found;
  if (verify::coincident(x, y, tolerance)) {  // the depth of duplicates takes long to bound and has no meaning
    found.place = verify::place_of_duplicate(x, y);
    return found;
  }
  const Penetration deepest = deepest_penetration(a, Pose{}, b, Pose{}, tolerance);
  if (deepest.depth > verify::rounding_of(tolerance)) return verify::of_overlap(x, y, deepest, tolerance);
  const std::optional<ContactClass> apart = classify_apart(a, b, tolerance, near);
  if (!apart) return std::nullopt;
  found.depth = deepest.depth;
  found.place.contact = *apart;
  return found;
}

}  // namespace dismantle
