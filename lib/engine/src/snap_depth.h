/// How little a straight motion cuts in that takes two parts apart.
#pragma once

#include "dismantle/assembly.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// What holds two parts, as they are assembled, against straight motions along the axes of their faces and of the
/// coordinates.
enum class Hold {
  none,    ///< one of them takes the parts apart
  little,  ///< one of them cuts in by no more than was asked about
  deep     ///< each of them cuts in by more, or the run was stopped
};

/// `most`: above the initial overlap. What cuts in by less than the tolerance is `little`, too: the verifier then
/// refuses it for another reason, a thin wall or a proof that failed.
Hold straight_hold(const Assembly& assembly, const Verifier& verifier, PartId a, PartId b, double most,
                   const RunContext& context);

}  // namespace dismantle
