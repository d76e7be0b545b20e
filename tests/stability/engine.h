/// A rigid-body engine (Bullet) as reference: it shares no code with lib/statics.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dismantle/mesh.h"

namespace dismantle::statics::testing {

/// Convex solids of density 1; the first `fixed` do not move.
struct Scene {
  std::vector<Mesh> solids;
  std::size_t fixed = 1;
  double friction = 0.4;
  Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
};

/// Lets the engine run and says how far the corner that moved most has moved. Gravity is 10 units of length per s2. The
/// engine has a pyramid about each friction cone.
double moved_in_engine(const Scene& scene, double seconds);

}  // namespace dismantle::statics::testing
