/// Balls that fit into a body, spread over it: samples of its medial axis.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dismantle/mesh.h"

namespace dismantle::free_space {

/// The largest ball inside the body that touches its surface at one sampled point. Frame and units of the mesh.
struct MedialBall {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// At most `max_count` balls. Their points on the surface are chosen by farthest-point sampling, so the first few are
/// far from each other.
std::vector<MedialBall> medial_balls(const Mesh& mesh, std::size_t max_count);

}  // namespace dismantle::free_space
