/// Samples of the surfaces that guide a body, from its contacts.
#pragma once

#include <vector>

#include "dismantle/geometry/slippage.h"
#include "dismantle/simulator.h"

namespace dismantle::push {

/// Contact points and normals on the fixed parts (world frame). Contacts with edges and corners are left out, because
/// their normals are not those of the surface.
std::vector<geometry::SurfaceSample> touching_surfaces(const std::vector<Contact>& contacts,
                                                       const std::vector<PlacedPart>& moving);

}  // namespace dismantle::push
