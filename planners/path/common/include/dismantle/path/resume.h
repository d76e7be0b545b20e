/// Contents that search states have in common.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "dismantle/simulator.h"

namespace dismantle::path {

/// A point where the verifier found contact and the world had none; given to World::add_contact_sample. Assembled frame
/// of `part`, assembly units.
struct ContactSample {
  PartId part, other;
  Eigen::Vector3d point;
};

/// The fixed parts of a scene, ascending: a search may be resumed with a subset of them.
inline std::vector<PartId> fixed_parts(const Scene& scene) {
  std::vector<PartId> parts;
  for (const auto& s : scene.fixed) parts.push_back(s.part);
  std::sort(parts.begin(), parts.end());
  return parts;
}

}  // namespace dismantle::path
