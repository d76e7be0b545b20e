#include "polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;
using Vec2 = Eigen::Vector2d;

struct Corner {
  Vec2 at;
  std::size_t source;
};

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Andrew's monotone chain; drops corners that bend by less than `flat`, an area.
std::vector<Corner> chain_hull(std::vector<Corner> all, double flat) {
  std::sort(all.begin(), all.end(), [](const Corner& a, const Corner& b) {
    return a.at.x() != b.at.x() ? a.at.x() < b.at.x() : a.at.y() < b.at.y();
  });
  std::vector<Corner> hull;
  const auto side = [&](auto first, auto last, std::size_t base) {
    for (auto it = first; it != last; ++it) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2].at, hull.back().at, it->at) <= flat) hull.pop_back();
      hull.push_back(*it);
    }
    hull.pop_back();
  };
  side(all.begin(), all.end(), 0);
  side(all.rbegin(), all.rend(), hull.size());
  return hull;
}

}  // namespace

void clip(const Polygon& polygon, const Vec3& normal, double limit, Polygon& kept) {
  kept.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& p = polygon[i];
    const Vec3& q = polygon[(i + 1) % polygon.size()];
    const double dp = normal.dot(p) - limit, dq = normal.dot(q) - limit;
    if (dp <= 0) kept.push_back(p);
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) kept.push_back(p + dp / (dp - dq) * (q - p));
  }
}

Vec3 area_of(const Polygon& polygon) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += 0.5 * (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  return sum;
}

Polygon hull_in_plane(std::span<const Vec3> points, const Vec3& normal, std::size_t most) {
  if (points.size() < 2) return {points.begin(), points.end()};
  Vec3 center = Vec3::Zero();
  for (const Vec3& p : points) center += p / static_cast<double>(points.size());
  Vec3 u = Vec3::Zero();  // towards the farthest point, so that the frame turns with the points
  for (const Vec3& p : points) {
    const Vec3 d = (p - center) - normal.dot(p - center) * normal;
    if (d.squaredNorm() > u.squaredNorm()) u = d;
  }
  const double size = u.norm();
  if (!(size > 0)) return {points.front()};
  u /= size;
  const Vec3 v = normal.cross(u);
  std::vector<Corner> all;
  for (std::size_t i = 0; i < points.size(); ++i)
    all.push_back({{u.dot(points[i] - center), v.dot(points[i] - center)}, i});
  std::vector<Corner> hull = chain_hull(std::move(all), 1e-9 * size * size);
  while (hull.size() > most) {  // drop the corner that holds the least area
    std::size_t least = 0;
    double area = 0;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const std::size_t n = hull.size();
      const double cut = turn(hull[(i + n - 1) % n].at, hull[i].at, hull[(i + 1) % n].at);
      if (i == 0 || cut < area) {
        area = cut;
        least = i;
      }
    }
    hull.erase(hull.begin() + static_cast<std::ptrdiff_t>(least));
  }
  Polygon corners;
  for (const Corner& c : hull) corners.push_back(points[c.source]);
  return corners;
}

}  // namespace dismantle::statics
