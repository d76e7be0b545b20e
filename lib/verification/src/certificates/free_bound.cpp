#include "certificates/free_bound.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace dismantle::certificates {

FreeBound::FreeBound(const Body& body) : frame_(body.frame), local_(body) {
  local_.box = Aabb();
  for (Vec3& v : local_.vertices) {
    v = frame_.conjugate() * v;
    local_.box.extend(v);
  }
  for (std::size_t t = 0; t < local_.triangles.size(); ++t) {
    Aabb& box = boxes_.emplace_back();
    for (const Vec3& c : local_.corners(t)) box.extend(c);
  }
}

double FreeBound::least(const Vec3& center, const Vec3& half, const Vec3& direction) const {
  const double rounding = rounding_of(local_.box);
  Aabb box{center - half, center + half};
  box.inflate(rounding);
  double least = std::numeric_limits<double>::infinity();
  std::vector<Vec3> polygon, rest;
  for (std::size_t t = 0; t < local_.triangles.size(); ++t) {
    if (!boxes_[t].overlaps(box)) continue;
    const Corners corners = local_.corners(t);
    polygon.assign(corners.begin(), corners.end());
    for (int d = 0; d < 3; ++d)
      for (const double side : {-1.0, 1.0}) {
        const auto room = [&](const Vec3& p) { return side > 0 ? box.hi[d] - p[d] : p[d] - box.lo[d]; };
        rest.clear();
        for (std::size_t k = 0; k < polygon.size(); ++k) {
          const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
          const double ra = room(a), rb = room(b);
          if (ra >= 0) rest.push_back(a);
          if ((ra >= 0) != (rb >= 0)) rest.push_back(a + ra / (ra - rb) * (b - a));
        }
        std::swap(polygon, rest);
      }
    for (const Vec3& p : polygon) least = std::min(least, direction.dot(p));
  }
  for (int k = 0; k < 8; ++k) {
    const Vec3 c(k & 1 ? box.hi.x() : box.lo.x(), k & 2 ? box.hi.y() : box.lo.y(), k & 4 ? box.hi.z() : box.lo.z());
    if (direction.dot(c) < least && !inside(c, local_)) least = direction.dot(c);
  }
  return least - rounding;
}

}  // namespace dismantle::certificates
