/// Which parts hold together without gravity.
#pragma once

#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/statics/contacts.h"

namespace dismantle::statics {

/// The part is a screw or a nut.
bool is_fastener(const Part& part);

/// The pair holds together without gravity: pressed, clipped, screwed. `gap`: an overlap of that depth is still
/// touching; assembly units.
bool is_bonded(const Assembly& assembly, PartId a, PartId b, double gap);

/// contacts_between() of a pair that is bonded or not. Bonded surfaces may lie deep in each other, by `overlap`; a thread
/// and its hole are drawn with any diameters between those of the crests and of the roots.
std::vector<Contact> pair_contacts(const PlacedShape& a, const PlacedShape& b, double touching, bool bonded,
                                   double overlap);

}  // namespace dismantle::statics
