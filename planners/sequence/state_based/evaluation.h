/// Which part to search for first: two evaluation functions on blocking graphs enriched with states.
#pragma once

#include "state_based/motion_states.h"
#include "state_based/state_based.h"

namespace dismantle::state_based {

/// Sorts `ids`, all of the group, the most promising first; the housing last. Directions along which the housing is
/// in the way do not count: it is what remains.
/// - fewest_blockers: the fewest others in the way of it, from any state along any direction; of equals the most
/// useful;
/// - most_useful: the use of a part is the sum of its shares in the smallest sets that are in the way of others; of
///   equals the one with fewest blockers.
Subassemblies by_evaluation(const blocking::DisassemblyState& state, const MotionStates& states,
                            const GroupState& group, Subassemblies ids, StateBasedEvaluation evaluation);

}  // namespace dismantle::state_based
