/// Which part to search for first: two evaluation functions on blocking graphs enriched with states.
#pragma once

#include "state_based/motion_states.h"
#include "state_based/state_based.h"

namespace dismantle::state_based {

/// Sorts `ids`, all of the group, the most promising first and the housing last. Directions along which the housing
/// blocks do not count, since it is what remains.
/// - fewest_blockers: the part with the smallest set of blockers, from any state along any direction; ties: the most
///   useful;
/// - most_useful: the use of a part is the sum of its shares in the smallest sets that block others; ties: the fewest
///   blockers.
Subassemblies by_evaluation(const blocking::DisassemblyState& state, const MotionStates& states,
                            const GroupState& group, Subassemblies ids, StateBasedEvaluation evaluation);

}  // namespace dismantle::state_based
