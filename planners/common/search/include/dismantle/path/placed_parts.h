/// Parts where they are placed, and where a state of a simulation has them.
#pragma once

#include <algorithm>
#include <vector>

#include "dismantle/simulator.h"

namespace dismantle::path {

inline bool contains(const std::vector<PlacedPart>& parts, PartId part) {
  return std::any_of(parts.begin(), parts.end(), [part](const PlacedPart& p) { return p.part == part; });
}

/// The bounding box; world axes, assembly units; empty without parts.
inline Aabb box_of(const Assembly& assembly, const std::vector<PlacedPart>& parts) {
  Aabb box;
  for (const PlacedPart& p : parts)
    for (const auto& v : assembly.parts[p.part].mesh->vertices) box.extend(p.pose * v);
  return box;
}

/// An instant of a path: the poses in their order.
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
