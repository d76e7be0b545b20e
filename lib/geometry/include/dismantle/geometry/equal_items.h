/// Which parts people count as the same item.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/geometry/congruent_parts.h"

namespace dismantle::geometry {

/// By part: the first part that is the same item. Parts of one shape (`shapes`, of find_congruent()) are one item; so
/// are two standard parts of one kind (screws, nuts, washers, bearings...) that only their triangles tell apart: as
/// long along their axis, of one handedness, and alike in volume, surface and moments of inertia. A kind whose parts
/// may differ from their mirror images is none of these. `kinds`: by part, see PartKind::kind; empty: not known.
DISMANTLE_API std::vector<std::size_t> equal_items(const std::vector<Part>& parts,
                                                   const std::vector<ShapePlacement>& shapes,
                                                   const std::vector<std::string>& kinds);

}  // namespace dismantle::geometry
