/// Screw motions that the contacts leave free: slippage analysis of the surfaces that touch.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/simulator.h"

namespace dismantle::push {

/// An instantaneous rigid motion, world axes: velocity of `center` and angular velocity about it.
struct Twist {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
};

/// Where `pose` is after following the screw motion of `twist` for `way` (|linear| + radius |angular| = 1: assembly
/// units).
Pose moved(const Pose& pose, const Twist& twist, const Eigen::Vector3d& center, double way);

/// Motions, one sign each, that slide along all contacts at once to first order: the eigenvectors with small
/// eigenvalues of the mean of j j^T, where j . twist is the speed at which a contact opens (Gelfand and Guibas, Shape
/// segmentation using local slippage analysis, 2004). A thread has one, its screw; a round shaft two, a turn and a
/// slide. In a space of several, pure translations are separated from turns, and of all turns about an axis the one
/// with the least translation is given. `radius` (> 0) makes a turn as large as a translation: |linear| + radius
/// |angular| = 1 in all results. Where a flat face blocks the way along the
/// axis of a turn, what would slip without it is given, too: a nut on a plate unscrews away from it. Depends on nothing
/// but the contacts: turned input gives turned twists. Few contacts:
/// empty.
std::vector<Twist> slipping(const std::vector<Contact>& contacts, const std::vector<PlacedPart>& moving,
                            const Eigen::Vector3d& center, double radius);

}  // namespace dismantle::push
