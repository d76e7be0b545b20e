/// Boxes and poses of parts in a scene or in a simulated state.
#pragma once

#include <algorithm>
#include <vector>

#include "dismantle/simulator.h"

namespace dismantle::path {

inline bool contains(const std::vector<PlacedPart>& parts, PartId part) {
  return std::any_of(parts.begin(), parts.end(), [part](const PlacedPart& p) { return p.part == part; });
}

/// Bounding box in world axes and assembly units; empty without parts.
inline Aabb box_of(const Assembly& assembly, const std::vector<PlacedPart>& parts) {
  Aabb box;
  for (const PlacedPart& p : parts)
    for (const auto& v : assembly.parts[p.part].mesh->vertices) box.extend(p.pose * v);
  return box;
}

/// The poses in the order of the parts, as in an instant of a path.
inline std::vector<Pose> poses_of(const std::vector<PlacedPart>& parts) {
  std::vector<Pose> poses;
  for (const PlacedPart& p : parts) poses.push_back(p.pose);
  return poses;
}
inline std::vector<Pose> poses_of(const State& state) {
  std::vector<Pose> poses;
  for (const auto& b : state.bodies) poses.push_back(b.pose);
  return poses;
}

}  // namespace dismantle::path
