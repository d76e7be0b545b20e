#include "certificates/hull_depth.h"

#include <algorithm>
#include <cmath>

namespace dismantle::certificates {
namespace {

/// True if all directions through a square on a face of the cube [-1, 1]^3 have enough support. `half`: of its edge.
bool supported(const std::vector<Vec3>& arms, double furthest, double radius, const Vec3& middle, const Vec3& e,
               const Vec3& f, double half, int divisions) {
  const Vec3 n = middle.normalized();
  double support = 0;
  for (const Vec3& arm : arms) support = std::max(support, n.dot(arm));
  if (!(support > radius)) return false;
  // sqrt(2) * half is the radius of the square. Projection to the unit sphere does not increase distances.
  if (support - std::sqrt(2.0) * half * furthest > radius) return true;
  if (divisions == 0) return false;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      if (!supported(arms, furthest, radius, middle + half * (x * e + y * f), e, f, 0.5 * half, divisions - 1))
        return false;
  return true;
}

}  // namespace

bool ball_in_hull(const Vec3& center, double radius, const std::vector<Vec3>& points) {
  std::vector<Vec3> arms;
  double furthest = 0;
  for (const Vec3& p : points) {
    arms.push_back(p - center);
    furthest = std::max(furthest, arms.back().norm());
  }
  // Eight divisions: directions less than a hundredth of a rad apart. Few squares are divided that far.
  for (int k = 0; k < 3; ++k)
    for (const double side : {-1.0, 1.0})
      if (!supported(arms, furthest, radius, side * Vec3::Unit(k), Vec3::Unit((k + 1) % 3), Vec3::Unit((k + 2) % 3), 1,
                     8))
        return false;
  return true;
}

}  // namespace dismantle::certificates
