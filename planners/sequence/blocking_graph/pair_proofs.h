/// Proofs that two parts of a group cannot be separated, however the others move, as searches have found them.
#pragma once

#include "blocking_graph/state.h"

namespace dismantle::blocking {

/// Such a proof about the part and another one of the group; null: none is known.
const Certificate* pair_proof(const DisassemblyState& state, const GroupState& group, PartId part);

/// Do such proofs connect all members? Then nothing leaves the group.
bool is_locked(const DisassemblyState& state, const GroupState& group);

}  // namespace dismantle::blocking
