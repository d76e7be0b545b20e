/// Which steps of a disassembly truly need which others to have been done.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/verification/verifier.h"
#include "plan_builder.h"

namespace dismantle {

/// Step b needs the earlier step a when it moves a part that a moved, or when its way would cut into the parts of a
/// where they were before a, as far as the verifier can tell with little effort, pair by pair. Steps that do not need
/// each other may be done in either order or simultaneously; only how far a part has to be taken until its hull is apart
/// depends on what is still there. [b]: those that it needs, ascending, without those that follow from others. Steps
/// from the one on at which `context` says to stop are taken to need all before them.
std::vector<std::vector<std::size_t>> needed_steps(const std::vector<RecordedStep>& steps, const Assembly& assembly,
                                                   const Verifier& verifier, const RunContext& context);

/// 1 for steps that need no other, else one more than the highest layer among those needed.
std::vector<unsigned> layers_of(const std::vector<std::vector<std::size_t>>& needed);

/// (a, b) for parts: b leaves in a step that needs the one in which a leaves. In the order of the steps.
std::vector<std::pair<PartId, PartId>> part_precedence(const std::vector<RecordedStep>& steps,
                                                       const std::vector<std::vector<std::size_t>>& needed);

}  // namespace dismantle
