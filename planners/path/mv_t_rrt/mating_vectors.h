/// Directions in which parts with mating faces separate (Ebinger et al. 2018).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle::mv_t_rrt {

/// Distinct face normals and their opposites, of the moving parts and of the fixed parts whose boxes are within `reach`
/// (assembly units) of them; unit vectors, world. A normal within `merge_angle` (rad) of a normal with more area, or of
/// its opposite, is merged into it. Sorted by area, largest first; at most `most`.
std::vector<Eigen::Vector3d> mating_vectors(const PathQuery& query, double reach, double merge_angle, std::size_t most);

}  // namespace dismantle::mv_t_rrt
