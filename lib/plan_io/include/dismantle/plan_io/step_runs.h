/// Steps that follow each other and do the same with equal parts: "4x screw".
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// Steps of the disassembly that follow each other. Each takes the same shapes out along the same directions while the
/// assembly lies alike, and none is forced.
struct StepRun {
  std::size_t first = 0;  ///< index into Plan::disassembly
  std::size_t count = 1;
};

/// By part of a plan: equal numbers for parts of one shape, or one item of the bill of materials.
using PartShapes = std::vector<std::size_t>;

/// By their surfaces, as bill_items() counts them.
/// @throws InputError when the plan has a part that the assembly lacks.
DISMANTLE_API PartShapes shapes_of(const Plan& plan, const Assembly& assembly);
/// The same for `items` of bill_items(), by part of the assembly.
DISMANTLE_API PartShapes shapes_of(const Plan& plan, const Assembly& assembly, const std::vector<std::size_t>& items);
/// By what the plan says alone: uses of one product are equal. Parts without a product are equal to no other.
DISMANTLE_API PartShapes shapes_of(const Plan& plan);

/// All steps of the disassembly, in their order, in the longest runs.
DISMANTLE_API std::vector<StepRun> step_runs(const Plan& plan, const PartShapes& shapes);

/// "4x screw", by the name of the first of its parts in the plan, without its number; "2x cover and 3 more" when each
/// step moves several.
DISMANTLE_API std::string run_words(const Plan& plan, const StepRun& run);

}  // namespace dismantle
