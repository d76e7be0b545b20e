/// Which steps of a disassembly depend on which earlier ones.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/disassembly.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// Step b needs the earlier step a if it moves a part that a moved, or if its path would cut into the parts of a at
/// their poses before a. The verifier decides this with little effort, pair by pair. Steps that do not need each other
/// may be done in either order or simultaneously; only the distance until the hulls are apart depends on the parts
/// still present. [b]: the steps that it needs, ascending, without those implied by others. When the
/// user cancels, the list ends with the last step that was looked at; what the others need is not known.
std::vector<std::vector<std::size_t>> needed_steps(const Disassembly& done, const Assembly& assembly,
                                                   const Verifier& verifier, const RunContext& context);

/// 1 for steps that need no other, else one more than the highest layer among those needed.
std::vector<unsigned> layers_of(const std::vector<std::vector<std::size_t>>& needed);

/// (a, b) for parts: b leaves in a step that needs the one in which a leaves. In the order of the steps.
std::vector<std::pair<PartId, PartId>> part_precedence(const Disassembly& done,
                                                       const std::vector<std::vector<std::size_t>>& needed);

}  // namespace dismantle
