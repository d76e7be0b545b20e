/// Which parts are one item of a bill of materials.
#pragma once

#include <cstddef>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/geometry/congruent_parts.h"
#include "dismantle/plan.h"

namespace dismantle {

/// By part: the first part that is the same item. Parts of one shape (`shapes`, of find_congruent()) are one item; so
/// are two standard parts of one kind (screws, nuts, washers, bearings...) that only their triangles tell apart: as
/// long along their axis, of one handedness, and alike in volume, surface and moments of inertia. A kind whose parts
/// may differ from their mirror images is none of these.
DISMANTLE_API std::vector<std::size_t> bill_items(const PlanAssembly& plan, const Assembly& assembly,
                                                  const std::vector<geometry::ShapePlacement>& shapes);

}  // namespace dismantle
