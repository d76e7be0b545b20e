/// ring: a circle lies deep in the first part, in a chamber of the second part whose openings are narrower.
///
/// Keep the second part fixed. Its surface never meets the circle, since it would be deeper in the first part than is
/// allowed. The chamber is a closed surface: a piece of that surface, and a flat cap across each curve that bounds the
/// piece. At first the circle crosses no cap, so the winding number of the chamber is the same about all points of the
/// circle, and it is not 0. A plane cuts the circle in two points or none, and the circle is never linked with the
/// border of a cap. So the circle crosses a cap in both points, equally often, or not at all. If it does, the chord
/// between the points is at most as long as the border is wide, so it is shorter than the diameter. The shorter of the
/// two arcs is then beyond the cap: it had no length when the crossing began, and the arcs could change roles only at a
/// chord of full length. The shorter arcs of all caps together are less than the circle. About all other points of the
/// circle the winding number is unchanged. So a point of the circle always has a winding number other than 0, and lies
/// in the hull of the second part. The parts are not apart.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "certificates/body.h"
#include "certificates/checker.h"
#include "certificates/circle.h"
#include "certificates/section.h"

namespace dismantle::certificates {
namespace {

/// A curve that bounds the piece. The piece is on the circle's side of the plane.
struct Opening {
  Plane plane;
  bool keeps_above = false;
  Loop loop;
};

/// The piece of surface between the openings, closed by caps.
class Chamber {
 public:
  Chamber(const Body& body, const Neighbours& neighbours, const std::vector<Opening>& openings)
      : body_(body), neighbours_(neighbours), openings_(openings), cut_by_(body.triangles.size()) {
    for (std::size_t i = 0; i < openings.size(); ++i)
      for (const std::uint32_t t : openings[i].loop.triangles) cut_by_[t].push_back(i);
  }

  /// Collects the piece from triangle to triangle. False: the piece has a border other than its openings.
  bool grow() {
    std::vector<char> seen(body_.triangles.size(), 0);
    std::vector<std::uint32_t> pending{openings_.front().loop.triangles.front()};
    seen[pending.front()] = 1;
    while (!pending.empty()) {
      const std::uint32_t t = pending.back();
      pending.pop_back();
      add(t);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = body_.triangles[t][k], b = body_.triangles[t][(k + 1) % 3], next = neighbours_[t][k];
        const auto outside = [&](std::size_t i) { return !kept(a, i) && !kept(b, i); };
        if (std::any_of(cut_by_[t].begin(), cut_by_[t].end(), outside)) continue;
        if (next == kNone) return false;
        // Both triangles must keep the same part of the edge, so the openings that cut it must cut both.
        const auto alien = [&](const std::vector<std::size_t>& mine, const std::vector<std::size_t>& others) {
          return std::any_of(mine.begin(), mine.end(), [&](std::size_t i) {
            return !(kept(a, i) && kept(b, i)) && std::find(others.begin(), others.end(), i) == others.end();
          });
        };
        if (alien(cut_by_[t], cut_by_[next]) || alien(cut_by_[next], cut_by_[t])) return false;
        if (!seen[next]) {
          seen[next] = 1;
          pending.push_back(next);
        }
      }
    }
    return true;
  }

  /// Winding number of the piece and its caps about a point. nullopt: the point is on the surface or a cap.
  std::optional<int> winding(const Vec3& p) const {
    double turns = 0;
    for (const Corners& c : triangles_) turns += solid_angle(p, c) / (4 * std::numbers::pi);
    if (std::abs(turns - std::round(turns)) > 1e-3) return std::nullopt;
    return static_cast<int>(std::round(turns));
  }

 private:
  bool kept(std::uint32_t vertex, std::size_t opening) const {
    return openings_[opening].plane.above(body_.vertices[vertex]) == openings_[opening].keeps_above;
  }

  /// Adds the part of a triangle between the openings, and for each edge along which an opening cuts it a triangle of
  /// the cap.
  void add(std::uint32_t t) {
    const Corners corners = body_.corners(t);
    std::vector<Vec3> polygon(corners.begin(), corners.end());
    for (const std::size_t i : cut_by_[t]) {
      const Opening& o = openings_[i];
      const auto in = [&](const Vec3& p) { return o.plane.above(p) == o.keeps_above; };
      std::vector<Vec3> rest, on_plane(2, Vec3::Zero());
      std::size_t crossed = 0;
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
        if (in(a)) rest.push_back(a);
        if (in(a) == in(b)) continue;
        rest.push_back(o.plane.cut(a, b));
        on_plane[in(a) ? 0 : 1] = rest.back();  // [0]: where the polygon leaves, [1]: where it comes back
        ++crossed;
      }
      if (crossed > 0) {
        const auto [apex, fresh] = apex_.try_emplace(i, on_plane[0]);
        triangles_.push_back({apex->second, on_plane[1], on_plane[0]});
      }
      polygon = std::move(rest);
    }
    for (std::size_t k = 2; k < polygon.size(); ++k) triangles_.push_back({polygon[0], polygon[k - 1], polygon[k]});
  }

  const Body& body_;
  const Neighbours& neighbours_;
  const std::vector<Opening>& openings_;
  std::vector<std::vector<std::size_t>> cut_by_;  // by triangle: openings
  std::vector<Corners> triangles_;
  std::map<std::size_t, Vec3> apex_;  // of each cap
};

/// The narrowest curve in the plane around the circle's axis.
std::optional<Loop> opening_in(const Body& body, const Neighbours& neighbours, const Plane& plane, const Vec3& center) {
  std::optional<Loop> narrowest;
  for (Loop& loop : section(body, neighbours, plane))
    if (loop.turns(center, plane) != 0 && (!narrowest || loop.diameter() < narrowest->diameter()))
      narrowest = std::move(loop);
  return narrowest;
}

std::string objection_to_chamber(const Circle& circle, const std::vector<double>& planes, double widest,
                                 const Body& body) {
  const double rounding = rounding_of(body.box);
  const Neighbours neighbours = neighbours_of(body);
  std::vector<Opening> openings;
  double arcs = 0;  // upper bound of the sum of the shorter arcs, rad
  for (const double offset : planes) {
    Opening o{{circle.axis, offset}, false, {}};
    if (!(std::abs(o.plane.height(circle.center)) > rounding)) return "the circle is in the plane of an opening";
    o.keeps_above = o.plane.above(circle.center);
    auto loop = opening_in(body, neighbours, o.plane, circle.center);
    if (!loop) return "one of its planes has no opening around the circle's axis";
    o.loop = std::move(*loop);
    const double width = o.loop.diameter();
    if (!(width <= widest + rounding)) return fmt::format("an opening is {:.6g} wide, not {:.6g}", width, widest);
    arcs += 2 * std::asin(std::min(1.0, (width + rounding) / (2 * circle.radius)));
    openings.push_back(std::move(o));
  }
  if (openings.empty()) return "it has no openings";
  if (!(arcs < 2 * std::numbers::pi * (1 - 1e-9))) return "its openings together may let all of the circle pass";
  Chamber chamber(body, neighbours, openings);
  if (!chamber.grow()) return "its openings do not close a chamber";
  if (chamber.winding(circle.point(1)).value_or(0) == 0) return "the circle is not in the chamber";
  return {};
}

}  // namespace

std::string objection_to_ring(const Certificate& certificate, const SeparationQuery& query, const RunContext& context) {
  const PartId inner = certificate.parts[0], outer = certificate.parts[1];
  const Circle circle = circle_of(certificate, "diameter");
  const double widest = certificate.numbers.at("opening").front();
  if (!(circle.radius > 0)) return "its numbers make no circle";
  if (!(widest < 2 * circle.radius - rounding_of(query, outer))) return "its opening is not narrower than its circle";
  const auto& holders = bodies_of(query, inner);
  if (std::none_of(holders.begin(), holders.end(),
                   [&](const Body& b) { return lies_deep(circle, b, allowed_depth(query, inner, outer)); }))
    return "its circle is not deep enough in the first part";
  std::string objection = "the second part is empty";
  for (const Body& body : bodies_of(query, outer)) {
    if (context.should_stop()) return "the check was stopped";
    objection = objection_to_chamber(circle, certificate.numbers.at("planes"), widest, body);
    if (objection.empty()) break;
  }
  return objection;
}

}  // namespace dismantle::certificates
