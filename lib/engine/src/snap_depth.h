/// How little a straight motion cuts in that takes two parts apart.
#pragma once

#include "dismantle/assembly.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// How deep two parts, as they are assembled, cut into each other beyond their initial overlap (assembly units), along
/// the straight motion that takes them apart and cuts in least: along the axes of their faces and of the coordinates.
/// To within a tolerance. -1: one of these motions is valid. Infinity: each cuts in by more than `most`, or the run was
/// stopped. What cuts in by less than the tolerance is refused by the verifier for another reason, a thin wall or a
/// proof that failed.
double straight_cut(const Assembly& assembly, const Verifier& verifier, PartId a, PartId b, double most,
                    const RunContext& context);

}  // namespace dismantle
