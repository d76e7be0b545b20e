/// How little a straight motion cuts in that takes two parts apart.
#pragma once

#include "dismantle/assembly.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// Does a straight motion along an axis of the faces of `a` or `b`, or along a coordinate axis, take the parts apart
/// as they are assembled and cut in, but by no more than `most` above the initial overlap? By less than the tolerance
/// counts, too: the verifier then refuses it for another reason, a thin wall or a proof that failed. False for parts
/// that such a motion takes apart.
bool cuts_in_little(const Assembly& assembly, const Verifier& verifier, PartId a, PartId b, double most,
                    const RunContext& context);

}  // namespace dismantle
