/// Which parts are one item of a bill of materials.
#pragma once

#include <cstddef>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/geometry/congruent_parts.h"
#include "dismantle/plan.h"

namespace dismantle {

/// By part: the first part that is the same item: geometry::equal_items() with the kinds that the plan states.
DISMANTLE_API std::vector<std::size_t> bill_items(const PlanAssembly& plan, const Assembly& assembly,
                                                  const std::vector<geometry::ShapePlacement>& shapes);

}  // namespace dismantle
