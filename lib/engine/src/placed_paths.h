/// Paths and boxes at other places.
#pragma once

#include <algorithm>

#include "dismantle/aabb.h"
#include "dismantle/path_planner.h"

namespace dismantle {

inline Path displaced(const Pose& displacement, const Path& path) {
  Path result = path;
  for (auto& instant : result)
    for (auto& pose : instant) pose = displacement * pose;
  return result;
}

inline Path backwards(Path path) {
  std::reverse(path.begin(), path.end());
  return path;
}

inline Aabb box_under(const Aabb& box, const Pose& pose) {
  Aabb out;
  for (int k = 0; k < 8; ++k)
    out.extend(pose * Eigen::Vector3d(k & 1 ? box.hi.x() : box.lo.x(), k & 2 ? box.hi.y() : box.lo.y(),
                                      k & 4 ? box.hi.z() : box.lo.z()));
  return out;
}

}  // namespace dismantle
