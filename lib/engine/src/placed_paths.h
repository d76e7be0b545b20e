/// Displaced and reversed paths.
#pragma once

#include <algorithm>

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

}  // namespace dismantle
