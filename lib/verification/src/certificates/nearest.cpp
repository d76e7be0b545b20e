#include "certificates/nearest.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace dismantle::certificates {
void NearestTriangles::add(const Body& body, const Pose& pose, double keep) {
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    Item item{body.corners(t), keep, Vec3::Zero(), 0};
    for (Vec3& c : item.corners) {
      c = pose * c;
      item.middle += c / 3;
      box_.extend(c);
    }
    for (const Vec3& c : item.corners) item.radius = std::max(item.radius, (c - item.middle).norm());
    all_.push_back(static_cast<std::uint32_t>(items_.size()));
    items_.push_back(item);
  }
}

double NearestTriangles::clearance(const Vec3& p, const List& list, double radius, List& kept) const {
  std::vector<std::pair<std::uint32_t, double>> near;
  double least = std::numeric_limits<double>::infinity();
  const double reach = 2 * radius * (1 + 1e-9);  // with a margin for rounding
  for (const std::uint32_t t : list) {
    const Item& item = items_[t];
    if ((p - item.middle).norm() - item.radius - item.keep > least + reach) continue;
    const double here = distance(p, item.corners) - item.keep;
    near.emplace_back(t, here);
    least = std::min(least, here);
  }
  kept.clear();
  for (const auto& [t, here] : near)
    if (here <= least + reach) kept.push_back(t);
  return least;
}

double NearestTriangles::clearance(const Vec3& p, const List& list) const {
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t t : list) {
    const Item& item = items_[t];
    if ((p - item.middle).norm() - item.radius - item.keep > least) continue;
    least = std::min(least, distance(p, item.corners) - item.keep);
  }
  return least;
}

NearestTriangles::List NearestTriangles::around(const Vec3& p, double reach, const List& list) const {
  List found;
  for (const std::uint32_t t : list)
    if ((p - items_[t].middle).norm() <= items_[t].radius + reach) found.push_back(t);
  return found;
}

NearestTriangles::List NearestTriangles::around_plane(const Vec3& p, const Vec3& normal, double reach,
                                                      const List& list) const {
  List found;
  for (const std::uint32_t t : list) {
    const Corners& c = items_[t].corners;
    const Vec3 height(normal.dot(c[0] - p), normal.dot(c[1] - p), normal.dot(c[2] - p));
    if (height.minCoeff() <= reach && height.maxCoeff() >= -reach) found.push_back(t);
  }
  return found;
}

}  // namespace dismantle::certificates
