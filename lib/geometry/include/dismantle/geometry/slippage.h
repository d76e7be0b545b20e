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

/// Motions of a whole surface along itself, about `center` (frame of the mesh): a screw's along its thread, a pin's
/// along and about its axis. Each moves the points of the surface by about 1. Most bodies have none.
DISMANTLE_API std::vector<Twist> slippable_motions(const Mesh& mesh, const Eigen::Vector3d& center);

/// Motions about `center`, one sign each, that slide along all samples, between which there may be play: of two
/// surfaces that guide each other, a few hundred contacts. A thread has one motion, its screw; a round shaft two, a
/// rotation and a translation. In a space of several, pure translations are separated from rotations, and of all
/// rotations about an axis the one with the least translation is given. Where nothing slips exactly, the least stiff
/// motion is given. Where a flat face blocks the motion along the axis of a rotation, what would slip without that face
/// is given, too: a nut on a plate unscrews away from it. Nothing depends on the axes of the world. Empty for less than
/// six samples, or when they leave more than four motions free.
///
/// `radius` (> 0) makes a rotation as large as a translation: |linear| + radius |angular| = 1 in all results.
DISMANTLE_API std::vector<Twist> slippable_motions(const std::vector<SurfaceSample>& contacts,
                                                   const Eigen::Vector3d& center, double radius);

/// The same of what is certain: no least stiff motion where nothing slips, and nothing without flat faces that block
/// both ways along the axis.
DISMANTLE_API std::vector<Twist> guided_motions(const std::vector<SurfaceSample>& contacts,
                                                const Eigen::Vector3d& center, double radius);

}  // namespace dismantle::geometry
