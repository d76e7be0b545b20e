/// disc: the centre of a flat disc inside the first part does not leave a region between walls of the second.
///
/// All points nearer to the disc than half its thickness are deeper in the first part than is allowed. Keep the second
/// part fixed. Its surface never comes that near to the disc. Whatever its orientation, the disc has a diameter
/// perpendicular to any given direction. So the centre cannot be within half the thickness of the surface, or inside.
/// Nor can it be where every line through it, in the plane perpendicular to some direction, comes that near to the
/// surface within the length of a diameter. The certificate has a region made of boxes. Its whole border is blocked in
/// this sense, so the centre stays in the region. If the parts could be apart, the centre could go anywhere.
///
/// The border consists of the faces of the boxes where no other box adjoins. It is divided into pieces, and the lines
/// through a piece into fans, until the middle line of each fan has a point so near to the surface that all lines of
/// the fan have one.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "certificates/body.h"
#include "certificates/checker.h"
#include "certificates/circle.h"
#include "certificates/nearest.h"

namespace dismantle::certificates {
namespace {

// In a region: proofs have dozens to hundreds. The time for the border grows with the square.
constexpr std::size_t kMostBoxes = 20'000;

/// The part of a convex polygon where normal . p <= most.
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, const Vec3& normal, double most) {
  std::vector<Vec3> rest;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double ha = normal.dot(a) - most, hb = normal.dot(b) - most;
    if (ha <= 0) rest.push_back(a);
    if ((ha <= 0) != (hb <= 0)) rest.push_back(a + ha / (ha - hb) * (b - a));
  }
  return rest;
}

/// True if the surface does not meet the cylinder about the disc that extends it by `margin` in height and radius. Then
/// all points within `margin` of the disc are on one side of the surface.
bool cylinder_is_free(const Circle& disc, double margin, const Body& body) {
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    std::vector<Vec3> polygon;
    for (const Vec3& c : body.corners(t)) polygon.push_back(c - disc.center);
    polygon = clipped(clipped(polygon, disc.axis, margin), -disc.axis, margin);
    if (polygon.empty()) continue;
    for (Vec3& p : polygon) p -= disc.axis.dot(p) * disc.axis;
    for (std::size_t k = 0; k < polygon.size(); ++k)
      if (distance(Vec3::Zero(), Corners{polygon[0], polygon[k], polygon[(k + 1) % polygon.size()]}) <
          disc.radius + margin)
        return false;
  }
  return true;
}

/// A rectangle: a box without width along one coordinate.
using Piece = Aabb;

/// Adds the parts of the piece outside a rectangle in the same plane to `rest`.
void cut_out(const Piece& piece, const Aabb& hole, Eigen::Index across, std::vector<Piece>& rest) {
  Piece left = piece;
  for (Eigen::Index d = 0; d < 3; ++d) {
    if (d == across) continue;
    if (!(hole.lo[d] < left.hi[d] && left.lo[d] < hole.hi[d])) return rest.push_back(piece);
  }
  for (Eigen::Index d = 0; d < 3; ++d) {
    if (d == across) continue;
    if (left.lo[d] < hole.lo[d]) {
      rest.push_back(left);
      rest.back().hi[d] = left.lo[d] = hole.lo[d];
    }
    if (left.hi[d] > hole.hi[d]) {
      rest.push_back(left);
      rest.back().lo[d] = left.hi[d] = hole.hi[d];
    }
  }
}

/// The faces of the boxes, except where another box adjoins.
std::vector<Piece> border_of(const std::vector<Aabb>& boxes, const RunContext& context) {
  std::vector<Piece> border, pieces, rest;
  for (const Aabb& box : boxes) {
    if (context.should_stop()) return border;  // the check ends, so an incomplete border does no harm
    for (Eigen::Index d = 0; d < 3; ++d)
      for (const bool upper : {false, true}) {
        Piece face = box;
        (upper ? face.lo : face.hi)[d] = (upper ? face.hi : face.lo)[d];
        const double at = face.lo[d];
        pieces = {face};
        for (const Aabb& other : boxes) {
          if (upper ? !(other.lo[d] <= at && at < other.hi[d]) : !(other.lo[d] < at && at <= other.hi[d])) continue;
          rest.clear();
          for (const Piece& p : pieces) cut_out(p, other, d, rest);
          std::swap(pieces, rest);
        }
        border.insert(border.end(), pieces.begin(), pieces.end());
      }
  }
  return border;
}

class Walls {
 public:
  Walls(const Circle& disc, double half, const std::vector<Body>& bodies, std::vector<Vec3> normals,
        const RunContext& context)
      : disc_(disc), half_(half), bodies_(bodies), normals_(std::move(normals)), context_(context) {
    for (const Body& body : bodies) walls_.add(body, Pose{}, 0);
    half_ -= rounding_of(walls_.box());
  }

  /// True if the disc's centre is neither near the surface nor inside.
  bool free(const Vec3& p) const {
    return walls_.clearance(p, walls_.all()) > half_ &&
           std::none_of(bodies_.begin(), bodies_.end(), [&](const Body& b) { return inside(p, b); });
  }

  /// Is the centre blocked at all points of the piece? `frame`: assembled = frame * local.
  bool blocked(const Piece& piece, const Pose& frame) { return blocked(piece, frame, walls_.all()); }

  bool spent() const { return steps_ > kMostSteps; }

 private:
  // Distances from triangles: a few seconds, many times what proofs need.
  static constexpr std::int64_t kMostSteps = 100'000'000;

  bool blocked(const Piece& piece, const Pose& frame, const NearestTriangles::List& list) {
    const Vec3 center = frame * piece.center();
    const double radius = 0.5 * piece.size().norm();
    const NearestTriangles::List around = walls_.around(center, radius + disc_.radius + half_, list);
    if (all_near(piece, frame, center, radius, around) || all_inside(center, radius, around)) return true;
    if (radius < 0.7 * half_)  // in a larger piece the lines differ too much in position
      for (Vec3& normal : normals_)
        if (no_diameter_fits(center, radius, normal, around)) {
          std::swap(normal, normals_.front());  // most likely also blocks the next piece
          return true;
        }
    if (radius < kSmallest * half_ || spent() || context_.should_stop()) return false;
    Piece below = piece, above = piece;
    Eigen::Index longest = 0;
    piece.size().maxCoeff(&longest);
    below.hi[longest] = above.lo[longest] = piece.center()[longest];
    return blocked(below, frame, around) && blocked(above, frame, around);
  }
  static constexpr double kSmallest = 1e-3;  // smallest radius of a piece, as a share of half the thickness

  /// The distance from a triangle is a convex function, so it is largest at a corner of the piece.
  bool all_near(const Piece& piece, const Pose& frame, const Vec3& center, double radius,
                const NearestTriangles::List& list) const {
    std::array<Vec3, 8> corners;
    for (unsigned k = 0; k < 8; ++k)
      corners[k] = frame * Vec3((k & 1U ? piece.hi : piece.lo).x(), (k & 2U ? piece.hi : piece.lo).y(),
                                (k & 4U ? piece.hi : piece.lo).z());
    for (const std::uint32_t t : walls_.around(center, half_, list))
      if (distance(center, walls_.corners(t)) + radius < 2 * half_ &&
          std::all_of(corners.begin(), corners.end(),
                      [&](const Vec3& c) { return distance(c, walls_.corners(t)) < half_; }))
        return true;
    return false;
  }

  bool all_inside(const Vec3& center, double radius, const NearestTriangles::List& list) const {
    return walls_.clearance(center, list) > radius &&
           std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& b) { return b.closed && inside(center, b); });
  }

  /// True if every line through a point of the ball, perpendicular to `normal`, comes near the surface within the
  /// disc's radius on at least one side.
  bool no_diameter_fits(const Vec3& center, double radius, const Vec3& normal, const NearestTriangles::List& list) {
    NearestTriangles::List around = walls_.around_plane(center, normal, radius + half_, list);
    const Vec3 e = normal.unitOrthogonal(), f = normal.cross(e);
    struct Fan {
      double angle, half;
    };
    constexpr int kFans = 8;
    std::vector<Fan> fans;
    for (int k = 0; k < kFans; ++k)
      fans.push_back({std::numbers::pi * (k + 0.5) / kFans, std::numbers::pi / 2 / kFans});
    while (!fans.empty()) {
      const Fan fan = fans.back();
      fans.pop_back();
      const Vec3 along = std::cos(fan.angle) * e + std::sin(fan.angle) * f;
      const Lines lines{center, along, normal.cross(along), radius, fan.half};
      // The triangle that blocks the last fan comes first.
      const auto blocking =
          std::find_if(around.begin(), around.end(), [&](std::uint32_t t) { return blocks(lines, t, true); });
      if (blocking != around.end()) {
        std::iter_swap(around.begin(), blocking);
        continue;
      }
      if (spent() || context_.should_stop() || fan.half * disc_.radius < kSmallest * half_) return false;
      const auto blocks_one = [&](std::uint32_t t) { return blocks(lines, t, false); };
      if (std::none_of(around.begin(), around.end(), blocks_one)) return false;
      fans.push_back({fan.angle - 0.5 * fan.half, 0.5 * fan.half});
      fans.push_back({fan.angle + 0.5 * fan.half, 0.5 * fan.half});
    }
    return true;
  }

  /// Diameters whose centre differs from `from` by at most `radius`, and whose angle differs by at most `spread`.
  struct Lines {
    Vec3 from, along, across;
    double radius, spread;
  };

  /// True if all of the lines come near the triangle; without `spread`, only those at the middle angle. Along a line,
  /// the distance from a triangle is convex, and so is the term for the angle. Golden section search finds the minimum.
  bool blocks(const Lines& lines, std::uint32_t triangle, bool spread) {
    const double angle = spread ? lines.spread : 0, enough = half_ - lines.radius;
    if (walls_.far_from_line(triangle, lines.from, lines.along, lines.across, disc_.radius, enough)) return false;
    const auto at = [&](double t) {
      ++steps_;
      return distance(lines.from + t * lines.along, walls_.corners(triangle)) + angle * std::abs(t);
    };
    constexpr double kGolden = 0.6180339887498949;
    double lo = -disc_.radius, hi = disc_.radius, a = hi - kGolden * (hi - lo), b = lo + kGolden * (hi - lo);
    double at_a = at(a), at_b = at(b);
    while (hi - lo > 0.05 * half_) {
      if (std::min(at_a, at_b) < enough) return true;
      if (std::min(at_a, at_b) - (hi - lo) * (1 + angle) > enough) return false;  // it changes no faster than that
      if (at_a < at_b) {
        hi = b, b = a, at_b = at_a;
        at_a = at(a = hi - kGolden * (hi - lo));
      } else {
        lo = a, a = b, at_a = at_b;
        at_b = at(b = lo + kGolden * (hi - lo));
      }
    }
    return std::min(at_a, at_b) < enough;
  }

  const Circle& disc_;
  double half_;
  const std::vector<Body>& bodies_;
  std::vector<Vec3> normals_;
  const RunContext& context_;
  NearestTriangles walls_;
  std::int64_t steps_ = 0;
};

std::vector<Vec3> vectors_of(const std::vector<double>& numbers) {
  std::vector<Vec3> vectors;
  for (std::size_t k = 0; k + 2 < numbers.size(); k += 3)
    vectors.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
  return vectors;
}

}  // namespace

std::string objection_to_disc(const Certificate& certificate, const SeparationQuery& query, const RunContext& context) {
  const PartId inner = certificate.parts[0], outer = certificate.parts[1];
  const auto& numbers = certificate.numbers;
  const Circle disc = circle_of(certificate, "diameter");
  const double half = numbers.at("half_thickness").front();
  if (!(disc.radius > 0) || !(half > 0)) return "its numbers make no disc";
  const double margin = half + allowed_depth(query, inner, outer);
  const auto& holders = bodies_of(query, inner);
  if (std::none_of(holders.begin(), holders.end(), [&](const Body& b) {
        return b.closed && inside(disc.center, b) && cylinder_is_free(disc, margin, b);
      }))
    return "its disc is not deep enough in the first part";

  const auto& f = numbers.at("frame");
  const Pose frame{{f[0], f[1], f[2]}, Eigen::Quaterniond(f[3], f[4], f[5], f[6]).normalized()};
  if (!(std::abs(Eigen::Vector4d(f[3], f[4], f[5], f[6]).norm() - 1) < 1e-9)) return "its frame is no rotation";
  std::vector<Vec3> normals = vectors_of(numbers.at("normals"));
  if (numbers.at("normals").size() % 3 != 0 || numbers.at("region").size() % 6 != 0)
    return "its lists have not the right length";
  for (Vec3& n : normals) {
    n.normalize();
    if (!n.allFinite() || !(std::abs(n.norm() - 1) < 1e-9)) return "a normal of it is none";
  }
  const std::vector<Vec3> corners = vectors_of(numbers.at("region"));
  std::vector<Aabb> region;
  for (std::size_t k = 0; k < corners.size(); k += 2) {
    region.push_back({corners[k], corners[k + 1]});
    if (!(region.back().size().minCoeff() > 0)) return "a box of its region is empty";
  }
  if (region.size() > kMostBoxes) return "its region has too many boxes";
  const Vec3 start = frame.inverse() * disc.center;
  if (std::none_of(region.begin(), region.end(), [&](const Aabb& box) { return box.contains(start); }))
    return "the disc is not in its region";
  const auto& bodies = bodies_of(query, outer);
  if (std::any_of(bodies.begin(), bodies.end(), [](const Body& b) { return !b.closed; }))
    return "the second part has a surface that is not closed";
  Walls walls(disc, half, bodies, std::move(normals), context);
  if (!walls.free(disc.center)) return "the disc is not outside of the second part";
  for (const Piece& piece : border_of(region, context)) {
    if (context.should_stop()) return "the check was stopped";
    if (walls.blocked(piece, frame)) continue;
    if (context.should_stop()) return "the check was stopped";
    if (walls.spent()) return "its region has too large a border";
    const Vec3 at = frame * piece.center();
    return fmt::format("the disc may leave its region near ({:.6g}, {:.6g}, {:.6g})", at.x(), at.y(), at.z());
  }
  return context.should_stop() ? "the check was stopped" : "";
}

}  // namespace dismantle::certificates
