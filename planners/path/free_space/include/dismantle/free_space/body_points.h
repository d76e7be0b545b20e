/// Points all over a body, in the middle between its walls.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dismantle/mesh.h"

namespace dismantle::free_space {

/// A point within a body, in the middle between its walls there: the centre of a ball that fits. Mesh's frame, units.
struct BodyPoint {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// At most `most` of them, as far from each other as can be.
std::vector<BodyPoint> body_points(const Mesh& mesh, std::size_t most);

}  // namespace dismantle::free_space
