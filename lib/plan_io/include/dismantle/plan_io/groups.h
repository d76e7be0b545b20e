/// Which parts are still together at each step of a disassembly.
#pragma once

#include <cstddef>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// What one step does to a group of parts that were together. Parts are indices into PlanAssembly::parts, ascending.
struct GroupSplit {
  std::vector<std::size_t> whole;             ///< the group before the step
  std::vector<std::size_t> rest;              ///< what stays; not empty
  std::vector<std::vector<std::size_t>> out;  ///< what is taken from it; none is empty
};

/// In the order of Plan::disassembly. An intermediate placement splits nothing; others split one group (a plan file may
/// say more). When a step names every part of a group in `separates`, its largest piece without a moving part is the
/// rest.
/// @throws InputError when the plan separates a part that its assembly lacks.
DISMANTLE_API std::vector<std::vector<GroupSplit>> follow_groups(const Plan& plan);

}  // namespace dismantle
