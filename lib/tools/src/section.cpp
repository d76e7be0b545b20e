#include "section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "plane.h"

namespace dismantle::tools {
namespace {

using Vec2 = Eigen::Vector2d;

/// Of a convex polygon and a segment; 0 where they meet.
double distance(const Piece& piece, const Vec2& a, const Vec2& b) {
  const Vec2 ab = b - a;
  bool left = true, right = true;
  double area = 0, least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < piece.count; ++i) {
    const Vec2 &c = piece.corner[i], &d = piece.corner[(i + 1) % piece.count], edge = d - c;
    const double side_a = cross(edge, a - c), side_b = cross(edge, b - c);
    if (side_a * side_b < 0 && cross(ab, c - a) * cross(ab, d - a) < 0) return 0;
    left &= side_a >= 0;
    right &= side_a <= 0;
    area += cross(c, d);
    least = std::min({least, squared_to_segment(a, c, d), squared_to_segment(b, c, d), squared_to_segment(c, a, b)});
  }
  return area != 0 && (left || right) ? 0 : std::sqrt(least);  // the segment begins in the polygon
}

/// Separating axes of an upright rectangle and a convex polygon. Touching is not meeting.
bool meet(const Piece& piece, const Vec2& low, const Vec2& high) {
  if (!(low.array() < high.array()).all()) return false;
  Vec2 least = piece.corner[0], most = piece.corner[0];
  for (std::size_t i = 1; i < piece.count; ++i) {
    least = least.cwiseMin(piece.corner[i]);
    most = most.cwiseMax(piece.corner[i]);
  }
  if (!(least.array() < high.array()).all() || !(most.array() > low.array()).all()) return false;
  const Vec2 middle = (low + high) / 2, half = (high - low) / 2;
  for (std::size_t i = 0; i < piece.count; ++i) {
    const Vec2 edge = piece.corner[(i + 1) % piece.count] - piece.corner[i], normal(edge.y(), -edge.x());
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (std::size_t k = 0; k < piece.count; ++k) {
      const double at = normal.dot(piece.corner[k] - middle);
      lo = std::min(lo, at);
      hi = std::max(hi, at);
    }
    const double reach = half.dot(normal.cwiseAbs());
    if (normal != Vec2::Zero() && (lo >= reach || hi <= -reach)) return false;
  }
  return true;
}

/// Of points, each widened by an angle to both sides, of a convex set that does not contain the axis.
Directions directions_of(const Vec2* points, const double* widths, std::size_t count) {
  const double first = std::atan2(points[0].y(), points[0].x());
  double lo = 0, hi = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = std::remainder(std::atan2(points[i].y(), points[i].x()) - first, 2 * std::numbers::pi);
    lo = std::min(lo, at - widths[i]);
    hi = std::max(hi, at + widths[i]);
  }
  return {first + (lo + hi) / 2, (hi - lo) / 2 + 1e-12};
}

constexpr double kAll = 4;  // more than pi

}  // namespace

Piece turned(const Piece& piece, const Eigen::Matrix2d& turn) {
  Piece out = piece;
  for (std::size_t i = 0; i < piece.count; ++i) out.corner[i] = turn * piece.corner[i];
  return out;
}

std::optional<Piece> piece_of(const std::array<Eigen::Vector3d, 3>& triangle, double low, double high) {
  std::array<Eigen::Vector3d, 5> polygon{triangle[0], triangle[1], triangle[2]}, cut;
  std::size_t count = 3;
  for (const double sign : {1.0, -1.0}) {
    const double level = sign * (sign > 0 ? low : high);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d &a = polygon[i], &b = polygon[(i + 1) % count];
      const double over_a = sign * a.z() - level, over_b = sign * b.z() - level;
      if (over_a > 0) cut[kept++] = a;
      if ((over_a > 0) != (over_b > 0)) cut[kept++] = a + over_a / (over_a - over_b) * (b - a);
    }
    if (kept == 0) return std::nullopt;
    polygon = cut;
    count = kept;
  }
  Piece piece;
  piece.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    piece.corner[i] = polygon[i].head<2>();
    piece.farthest = std::max(piece.farthest, piece.corner[i].norm());
  }
  piece.nearest = distance(piece, Vec2::Zero(), Vec2::Zero());
  constexpr std::array<double, 5> kNone{};
  piece.directions = piece.nearest > 0 ? directions_of(piece.corner.data(), kNone.data(), count) : Directions{0, kAll};
  return piece;
}

Outline::Outline(const Volume& v) : volume(&v) {
  const double wide = v.form == Form::obround ? v.radius : 0;
  half_width = v.form == Form::obround ? wide : (v.to - v.from).minCoeff() / 2;
  if (v.form == Form::obround) {
    nearest = std::max(0.0, point_to_segment(Vec2::Zero(), v.from, v.to) - wide);
    farthest = std::max(v.from.norm(), v.to.norm()) + wide;
    const std::array<Vec2, 2> ends{v.from, v.to};
    directions = {0, kAll};
    if (nearest > 0) {
      const std::array<double, 2> widths{std::asin(wide / v.from.norm()), std::asin(wide / v.to.norm())};
      directions = directions_of(ends.data(), widths.data(), 2);
    }
  } else {
    const std::array<Vec2, 4> corners{v.from, Vec2{v.to.x(), v.from.y()}, v.to, Vec2{v.from.x(), v.to.y()}};
    nearest = v.from.cwiseMax(-v.to).cwiseMax(0).norm();
    farthest = 0;
    for (const Vec2& c : corners) farthest = std::max(farthest, c.norm());
    constexpr std::array<double, 4> kNone{};
    directions = nearest > 0 ? directions_of(corners.data(), kNone.data(), 4) : Directions{0, kAll};
  }
}

double Outline::distance_to(const Vec2& p) const {
  if (volume->form == Form::obround)
    return std::max(0.0, point_to_segment(p, volume->from, volume->to) - volume->radius);
  return (volume->from - p).cwiseMax(p - volume->to).cwiseMax(0).norm();
}

Seen Outline::look(const Piece& at, double margin) const {
  if (volume->form == Form::obround) {
    const double off = distance(at, volume->from, volume->to);
    if (off > volume->radius + margin) return Seen::clear;
    return off < volume->radius - margin ? Seen::pierced : Seen::undecided;
  }
  if (!meet(at, volume->from.array() - margin, volume->to.array() + margin)) return Seen::clear;
  return meet(at, volume->from.array() + margin, volume->to.array() - margin) ? Seen::pierced : Seen::undecided;
}

}  // namespace dismantle::tools
