/// Certificates of standing and of falling, and their check. The check shares no code with the solver: it only adds up
/// forces and compares displacements.
#pragma once

#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/statics/pile.h"

namespace dismantle::statics {

/// Relative rounding that certificates may have: of forces, by the weight that is carried; of displacements, by the
/// largest one.
inline constexpr double kCertificateTolerance = 1e-6;

/// Checks that each body is in equilibrium under weights, pushes and `forces`, and that each force lies in its friction
/// cone. Empty: it holds; otherwise what is wrong.
DISMANTLE_API std::string check_equilibrium(const Pile& pile, const ContactForces& forces);

/// Checks that `motion` creates `forces`: a contact point carries a force only where the motion presses the bodies
/// together, and friction opposes the sliding there.
DISMANTLE_API std::string check_created(const Pile& pile, const ContactForces& forces, const Motions& motion);

/// Checks that no forces in the friction cones can balance the load: every force that a contact allows does work >= 0
/// in `motion`, the load does work > 0. (Farkas' lemma.)
DISMANTLE_API std::string check_fall(const Pile& pile, const Motions& motion);

/// The same pile, and nothing rubs.
DISMANTLE_API Pile without_friction(Pile pile);

/// Weight of the lighter body of a contact that can move; 0: none can.
DISMANTLE_API double lighter_weight(const Pile& pile, const Contact& contact);

/// Sum of the forces along the normal.
DISMANTLE_API double pressure_of(const Contact& contact, const std::vector<Eigen::Vector3d>& forces);

/// Is there a contact on which the pressures differ?
DISMANTLE_API bool press_differently(const Pile& pile, const ContactForces& forces, const ContactForces& others);

/// Checks what is certified of a pile that stands only if it was pressed in: `forces` balance the load, and so do
/// `others`, which press differently on a contact, so that the load does not determine the pressures; and without
/// friction it falls by `slide`. That no displacement creates such forces does not follow, and is not checked.
DISMANTLE_API std::string check_pressed_in(const Pile& pile, const ContactForces& forces, const ContactForces& others,
                                           const Motions& slide);

/// Forces of springs at the contact points in a displacement: each is the projection on the friction cone of minus the
/// displacement, times the weight of the lighter body that can move. They lie in their cones, whatever the
/// displacement.
DISMANTLE_API ContactForces spring_forces(const Pile& pile, const Motions& displacement);

}  // namespace dismantle::statics
