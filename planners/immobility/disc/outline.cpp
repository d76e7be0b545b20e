#include "disc/outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dismantle::immobility {

namespace {
using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
}  // namespace

double distance(const Outline& outline, const Vec2& p) {
  double least = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2 &a = outline[k], along = outline[(k + 1) % outline.size()] - a, to = p - a;
    if (cross(along, to) >= 0) continue;
    inside = false;  // the closest point is on an edge that the point is outside of
    const double t = std::clamp(to.dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (to - t * along).squaredNorm());
  }
  return inside ? 0 : std::sqrt(least);
}

Outline hull_of(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  Outline hull;
  for (const bool upper : {false, true}) {
    const std::size_t first = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() > first + 1 && !(cross(hull.back() - hull[hull.size() - 2], p - hull.back()) > 0))
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    if (!upper) std::reverse(points.begin(), points.end());
  }
  return hull;
}

std::pair<Outline, Outline> cut(const Outline& piece, const Vec2& a, const Vec2& along) {
  std::pair<Outline, Outline> parts;
  for (std::size_t k = 0; k < piece.size(); ++k) {
    const Vec2 &p = piece[k], &q = piece[(k + 1) % piece.size()];
    const double s = cross(along, p - a), t = cross(along, q - a);
    if (s >= 0) parts.first.push_back(p);
    if (s <= 0) parts.second.push_back(p);
    if ((s > 0 && t < 0) || (s < 0 && t > 0)) {
      const Vec2 x = p + s / (s - t) * (q - p);
      parts.first.push_back(x);
      parts.second.push_back(x);
    }
  }
  return parts;
}

double area(const Outline& piece) {
  double twice = 0;
  for (std::size_t k = 2; k < piece.size(); ++k) twice += cross(piece[k - 1] - piece[0], piece[k] - piece[0]);
  return 0.5 * twice;
}

Aabb flat_box(const std::vector<Vec2>& points) {
  Aabb box;
  for (const Vec2& p : points) box.extend(Vec3(p.x(), p.y(), 0));
  return box;
}

}  // namespace dismantle::immobility
