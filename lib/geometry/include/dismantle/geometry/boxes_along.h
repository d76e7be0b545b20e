/// Boxes that a straight motion may bring together.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>

#include "dismantle/aabb.h"

namespace dismantle::geometry {

/// Does the box touch `other` at some time when it moves along `d`, however far?
inline bool meets_along(const Aabb& box, const Aabb& other, const Eigen::Vector3d& d) {
  double from = 0, to = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const double low = other.lo[k] - box.hi[k], high = other.hi[k] - box.lo[k];
    if (d[k] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double a = low / d[k], b = high / d[k];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to;
}

}  // namespace dismantle::geometry
