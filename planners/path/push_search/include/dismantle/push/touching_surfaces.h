/// The surfaces that guide a body, from its contacts.
#pragma once

#include <vector>

#include "dismantle/geometry/slippage.h"
#include "dismantle/simulator.h"

namespace dismantle::push {

/// Points of fixed parts that the world lists as contacts of what moves (world axes). Contacts with edges and corners
/// are left out: their normals are not those of the surface.
std::vector<geometry::SurfaceSample> touching_surfaces(const std::vector<Contact>& contacts,
                                                       const std::vector<PlacedPart>& moving);

}  // namespace dismantle::push
