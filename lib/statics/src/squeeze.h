/// Other forces that balance the same load.
#pragma once

#include <functional>

#include "dismantle/statics/pile.h"

namespace dismantle::statics {

/// Forces that balance the load as `forces` do, and press another way: a contact that moves in `motion` is squeezed.
/// Empty: none were found; the load determines the pressures there.
ContactForces squeezed_forces(const Pile& pile, const ContactForces& forces, const Motions& motion,
                              const std::function<bool()>& stop);

}  // namespace dismantle::statics
