/// Which constraint of the user a step would break.
#pragma once

#include <span>
#include <string>

#include "dismantle/constraints.h"
#include "dismantle/disassembly.h"
#include "dismantle/export.h"

namespace dismantle {

/// In words that complete "not possible: "; empty: none. `group`: all parts of the group that the step's parts are in.
DISMANTLE_API std::string broken_constraint(const DisassemblyStep& step, std::span<const PartId> group,
                                            const Constraints& constraints);

}  // namespace dismantle
