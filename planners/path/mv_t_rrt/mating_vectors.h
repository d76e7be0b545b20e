/// Directions in which parts that were put together face to face come apart (Ebinger et al. 2018).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle::mv_t_rrt {

/// Distinct face normals, both ways, of what moves and of the fixed parts whose boxes come within `reach` (assembly
/// units) of it; unit, world. Normals closer than `merge_angle` (rad) to one of more area, or to its opposite, are
/// taken for that one. Most area first, at most `most`.
std::vector<Eigen::Vector3d> mating_vectors(const PathQuery& query, double reach, double merge_angle, std::size_t most);

}  // namespace dismantle::mv_t_rrt
