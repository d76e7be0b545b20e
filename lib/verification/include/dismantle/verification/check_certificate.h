/// Checks the proof that parts cannot be separated, without the prover that found it.
#pragma once

#include <optional>
#include <string>

#include "dismantle/export.h"
#include "dismantle/immobility_prover.h"

namespace dismantle {

/// What is wrong with a certificate, by a small checker of its kind that shares no code with the provers; empty when it
/// holds. The query has the certificate's first part moving and the others fixed, where the certificate has them.
/// Nothing: there is no such checker, as for kinds of provers out of tree.
DISMANTLE_API std::optional<std::string> independent_objection(const Certificate& certificate,
                                                               const SeparationQuery& query, const RunContext& context);

}  // namespace dismantle
