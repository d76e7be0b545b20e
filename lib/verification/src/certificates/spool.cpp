/// spool: a circle lies deep in the second part. The first part goes through it, between two rims that are wider.
///
/// Keep the second part fixed. The surface of the first part never meets the circle, since it would be deeper than is
/// allowed. So a line on this surface from rim to rim never meets the circle either. Nor do the convex hulls H of the
/// rims, and the short segments between the rims and H, since the circle is deeper by the distance between them. A
/// plane cuts H in two points or none, and H is never linked with the circle. So H crosses the circle's disc in two
/// points or none. The chord between the points is at most as long as the circle is wide. It does not reach the middle
/// of H, since all points of H are further from there than the circle's radius. So the chord cuts off one arc, on the
/// side where the middle is not. This arc begins and ends with length 0. Add the crossings of the line with the disc
/// and the ends of the line that are on such arcs. The parity of the sum never changes: only an end that crosses the
/// disc changes the counts, and it changes both by one. At first the sum is 1. If the parts were apart it would be 0.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "certificates/body.h"
#include "certificates/checker.h"
#include "certificates/circle.h"
#include "certificates/section.h"

namespace dismantle::certificates {
namespace {

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Indices of the corners, counter-clockwise.
std::vector<std::size_t> convex_hull(const std::vector<Vec2>& points) {
  std::vector<std::size_t> order(points.size()), hull;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
    const Vec2 &a = points[i], &b = points[k];
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t first = hull.size();
    for (const std::size_t k : order) {
      while (hull.size() >= first + 2) {
        const Vec2 &a = points[hull[hull.size() - 2]], &b = points[hull.back()];
        if (cross(b - a, points[k] - b) > 0) break;
        hull.pop_back();
      }
      hull.push_back(k);
    }
    hull.pop_back();
    std::reverse(order.begin(), order.end());
  }
  return hull;
}

double distance_to_line(const Vec2& p, const Vec2& a, const Vec2& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + t * (b - a) - p).norm();
}

/// Distance of a closed curve through the points from its convex hull. Each edge of the hull has its own piece of the
/// curve between its ends. No point of the edge is further from the piece than the furthest corner of the piece is from
/// the edge: as a point moves along the piece, its nearest point on the edge moves along the whole edge.
double off_hull(const std::vector<Vec2>& points, const std::vector<std::size_t>& hull) {
  const std::size_t n = points.size();
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t step : {std::size_t{1}, n - 1}) {  // counter-clockwise or clockwise curve
    double most = 0;
    for (std::size_t k = 0; k < hull.size(); ++k) {
      const std::size_t end = hull[(k + 1) % hull.size()];
      for (std::size_t i = hull[k]; i != end; i = (i + step) % n)
        most = std::max(most, distance_to_line(points[i], points[hull[k]], points[end]));
    }
    least = std::min(least, most);
  }
  return least;
}

/// A rim and its convex curve.
struct Rim {
  Loop loop;
  double reach = 0;    ///< distance of the curve from its middle, the projected circle centre; 0: it is outside
  double off = 0;      ///< distance of the rim from the curve
  bool above = false;  ///< on the side of the circle's plane to which the axis points
};

Rim rim_of(Loop loop, const Plane& plane, const Vec3& center) {
  const Vec3 e = plane.normal.unitOrthogonal(), f = plane.normal.cross(e);
  const auto flat = [&](const Vec3& p) { return Vec2(e.dot(p), f.dot(p)); };
  std::vector<Vec2> points;
  for (const Vec3& p : loop.points) points.push_back(flat(p));
  const std::vector<std::size_t> hull = convex_hull(points);
  Rim rim{std::move(loop), 0, 0, false};
  if (hull.size() < 3) return rim;
  const Vec2 middle = flat(center);
  double reach = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const Vec2 &a = points[hull[k]], &b = points[hull[(k + 1) % hull.size()]];
    if (!(cross(b - a, middle - a) > 0)) return rim;
    reach = std::min(reach, distance_to_line(middle, a, b));
  }
  rim.reach = reach;
  rim.off = off_hull(points, hull);
  return rim;
}

/// Vertices that edges on one side of the plane connect to `from`.
std::vector<char> joined(const std::vector<std::vector<std::uint32_t>>& edges, const Body& body, const Plane& plane,
                         std::uint32_t from) {
  const bool above = plane.above(body.vertices[from]);
  std::vector<char> seen(body.vertices.size(), 0);
  std::vector<std::uint32_t> pending{from};
  seen[from] = 1;
  while (!pending.empty()) {
    const std::uint32_t v = pending.back();
    pending.pop_back();
    for (const std::uint32_t w : edges[v])
      if (!seen[w] && plane.above(body.vertices[w]) == above) {
        seen[w] = 1;
        pending.push_back(w);
      }
  }
  return seen;
}

/// True if a line along edges of the surface leads from a rim above the circle's plane to a rim below it and crosses
/// the plane once, within the circle.
bool passes(const Circle& circle, const Body& body, const Neighbours& neighbours, const std::vector<Rim>& rims,
            double rounding) {
  const Plane plane{circle.axis, circle.axis.dot(circle.center)};
  std::vector<std::vector<std::uint32_t>> edges(body.vertices.size());
  for (const Triangle& t : body.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      edges[t[k]].push_back(t[(k + 1) % 3]);
      edges[t[(k + 1) % 3]].push_back(t[k]);
    }
  // The line ends where a rim crosses an edge, after reaching an end of this edge on its side of the plane.
  const auto reaches_rim = [&](std::uint32_t from) {
    const auto seen = joined(edges, body, plane, from);
    return std::any_of(rims.begin(), rims.end(), [&](const Rim& rim) {
      return rim.above == plane.above(body.vertices[from]) &&
             std::any_of(rim.loop.edges.begin(), rim.loop.edges.end(),
                         [&](const auto& e) { return seen[e[0]] != 0 || seen[e[1]] != 0; });
    });
  };
  for (const Loop& neck : section(body, neighbours, plane)) {
    for (std::size_t k = 0; k < neck.points.size(); ++k) {
      if (!((neck.points[k] - circle.center).norm() < circle.radius - rounding)) continue;
      if (reaches_rim(neck.edges[k][0]) && reaches_rim(neck.edges[k][1])) return true;
      break;  // the ends of other edges of this curve connect to the same vertices
    }
  }
  return false;
}

std::string objection_to_rims(const Circle& circle, const std::vector<double>& planes, double width, const Body& spool,
                              double& off) {
  const double rounding = rounding_of(spool.box);
  const Neighbours neighbours = neighbours_of(spool);
  std::vector<Rim> rims;
  double side = 1;
  for (const double offset : planes) {
    const Plane plane{circle.axis, offset};
    const double height = plane.height(circle.center);
    if (!(std::abs(height) > rounding)) return "the circle is in the plane of a rim";
    side *= height;
    std::optional<Rim> best;  // the most convex of those that are wide enough
    double widest = 0;
    for (Loop& loop : section(spool, neighbours, plane)) {
      Rim rim = rim_of(std::move(loop), plane, circle.center);
      widest = std::max(widest, 2 * rim.reach);
      if (2 * rim.reach >= width - rounding && (!best || rim.off < best->off)) best = std::move(rim);
    }
    if (!best) return fmt::format("a rim is {:.6g} wide, not {:.6g}", widest, width);
    best->above = height < 0;  // the circle is below the rim's plane
    off = std::max(off, best->off);
    rims.push_back(std::move(*best));
  }
  if (!(side < 0)) return "both rims are on one side of the circle";
  return passes(circle, spool, neighbours, rims, rounding) ? "" : "the first part does not go through the circle";
}

}  // namespace

std::string objection_to_spool(const Certificate& certificate, const SeparationQuery& query,
                               const RunContext& context) {
  const PartId inner = certificate.parts[0], outer = certificate.parts[1];
  const Circle circle = circle_of(certificate, "circle");
  const double width = certificate.numbers.at("rim").front();
  if (!(circle.radius > 0)) return "its numbers make no circle";
  if (!(width > 2 * circle.radius + 4 * rounding_of(query, inner))) return "its rim is not wider than its circle";
  std::string objection = "the first part is empty";
  for (const Body& body : bodies_of(query, inner)) {
    if (context.should_stop()) return "the check was stopped";
    double off = 0;
    objection = objection_to_rims(circle, certificate.numbers.at("planes"), width, body, off);
    if (!objection.empty()) continue;
    const auto& holders = bodies_of(query, outer);
    if (std::any_of(holders.begin(), holders.end(), [&](const Body& b) {
          return lies_deep(circle, b, allowed_depth(query, inner, outer) + off + rounding_of(body.box));
        }))
      return {};
    objection = "its circle is not deep enough in the second part";
  }
  return objection;
}

}  // namespace dismantle::certificates
