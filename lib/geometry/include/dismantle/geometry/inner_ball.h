/// Balls within a closed surface that touch it: samples of its medial axis.
#pragma once

#include <Eigen/Core>

#include "dismantle/export.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle {

/// Radius of the largest ball within the surface that touches it at `p`, at most `most`; 0 if there is none. A ball
/// that is too large is shrunk until it only touches the surface it intersected (Ma, Bae and Choi 2012). All lengths in
/// the mesh's units, all vectors in its frame; `inward` is the unit normal at `p` into the solid. Within 1e-7.
DISMANTLE_API double inner_ball_radius(const TriangleBvh& surface, const Eigen::Vector3d& p,
                                       const Eigen::Vector3d& inward, double most);

}  // namespace dismantle
