/// Points all over a body, and the small motion that takes them where each wants to go.
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

/// A small rigid motion about a point.
struct Twist {
  Eigen::Vector3d way = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();  ///< rotation vector, rad
};

/// The one that moves each of the points most nearly by what is wished for it: least squares, with weights >= 0 of
/// which one is positive. About `center`.
Twist closest_twist(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3d>& wishes,
                    const std::vector<double>& weights, const Eigen::Vector3d& center);

}  // namespace dismantle::free_space
