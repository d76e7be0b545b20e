/// The number by which people know a step: one in the disassembly, one in the assembly.
#pragma once

#include <cstddef>

#include "dismantle/plan.h"

namespace dismantle {

/// Number, from 1, of the step Plan::disassembly[index]. In the assembly, which is the disassembly backwards, it is that
/// of the step in Plan::assembly_steps. Page, book, lists and commands use these numbers and no others.
inline std::size_t step_number(const Plan& plan, std::size_t index, bool disassembly) {
  return disassembly ? index + 1 : plan.disassembly.size() - index;
}

}  // namespace dismantle
