/// Motions of a body along its own surface: a screw's along its thread, a pin's along and about its axis.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/free_space/body_points.h"
#include "dismantle/mesh.h"

namespace dismantle::free_space {

/// Twists about `center` (mesh's frame) under which the surface moves hardly anywhere across itself, of those that
/// differ; each moves points of the surface by about 1. Most bodies have none.
///
/// The mean square of the speed across the surface is a quadratic form of the twist; they are its eigenvectors of small
/// eigenvalues (Pottmann, Randrup, Kinematical and reverse engineering of surfaces, 1998; Gelfand, Guibas, Shape
/// segmentation using local slippage analysis, 2004).
std::vector<Twist> slips(const Mesh& mesh, const Eigen::Vector3d& center);

}  // namespace dismantle::free_space
