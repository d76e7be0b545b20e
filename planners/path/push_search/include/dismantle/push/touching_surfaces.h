/// The surfaces that guide a body, as its contacts tell them.
#pragma once

#include <vector>

#include "dismantle/geometry/slippage.h"
#include "dismantle/simulator.h"

namespace dismantle::push {

/// Where fixed parts touch or nearly touch what moves (world axes). Contacts with edges and corners are left out: their
/// normals tell nothing of the surface.
std::vector<geometry::SurfaceSample> touching_surfaces(const std::vector<Contact>& contacts,
                                                       const std::vector<PlacedPart>& moving);

}  // namespace dismantle::push
