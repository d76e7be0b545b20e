/// Motions under which a surface slides along itself: slippage analysis.
///
/// The mean square of the speed across the surface is a quadratic form of the twist; the motions are its eigenvectors
/// of small eigenvalues (Pottmann and Randrup, Rotational and helical surface approximation for reverse engineering,
/// 1998; Gelfand and Guibas, Shape segmentation using local slippage analysis, 2004).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/geometry/twist.h"
#include "dismantle/mesh.h"

namespace dismantle::geometry {

/// A place on a surface, with its unit normal.
struct SurfaceSample {
  Eigen::Vector3d point, normal;
};

/// Motions of a whole surface along itself, about `center` (frame of the mesh): of a screw along its thread, of a pin
/// along and about its axis. Each moves the points of the surface by about 1. Most bodies have none.
DISMANTLE_API std::vector<Twist> slippable_motions(const Mesh& mesh, const Eigen::Vector3d& center);

/// Motions about `center`, one sign each, that slide along all contacts of two surfaces that guide each other. There
/// may be play; a few hundred contacts are typical. A thread has one motion, its screw; a round shaft two, a rotation
/// and a translation. In a space of several motions, pure translations are separated from rotations, and of all
/// rotations about an axis the one with the least translation is given. If no motion slips exactly, the least stiff one
/// is given. If a flat face blocks the motion along the axis of a rotation, the motions without that face are given,
/// too: a nut on a plate unscrews away from it. Results do not depend on the world axes. Empty for less than six
/// samples, or when they leave more than four motions free.
///
/// `radius` (> 0) makes a rotation as large as a translation: |linear| + radius |angular| = 1 in all results.
DISMANTLE_API std::vector<Twist> slippable_motions(const std::vector<SurfaceSample>& contacts,
                                                   const Eigen::Vector3d& center, double radius);

/// As above, but only certain motions: no least stiff motion when none slips, and none that ignores flat faces which
/// block both directions along the axis.
DISMANTLE_API std::vector<Twist> guided_motions(const std::vector<SurfaceSample>& contacts,
                                                const Eigen::Vector3d& center, double radius);

}  // namespace dismantle::geometry
