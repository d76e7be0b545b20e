/// Why parts are left at the end of a run.
#pragma once

#include <vector>

#include "dismantle/engine/proof_options.h"
#include "dismantle/sequence_planner.h"
#include "proof_schedule.h"

namespace dismantle {

/// The sequence planner's reasons for the parts of these groups, completed, without impossible claims.
std::vector<Unsolved> reasons_of(const SequenceResult& said, const std::vector<std::vector<PlacedPart>>& groups);

/// Tries proofs for parts that have none, independent of the planners used. A proof explains more than the message of a
/// search does. `groups`: the groups that the parts are left in.
void prove_left(std::vector<Unsolved>& unsolved, const std::vector<std::vector<PlacedPart>>& groups,
                ProofSchedule& proofs, const ProofOptions& options, const RunContext& context);

}  // namespace dismantle
