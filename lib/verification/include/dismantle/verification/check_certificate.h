/// Checks the proof that parts cannot be separated, without the prover that found it.
#pragma once

#include <optional>
#include <string>

#include "dismantle/export.h"
#include "dismantle/immobility_prover.h"

namespace dismantle {

/// Checks a certificate with the independent checker of its kind, which shares no code with the provers. Returns what
/// is wrong with it; empty when it holds. Returns nullopt for kinds without such a checker, as those of out-of-tree
/// provers. In the query the certificate's first part moves and the others are fixed, at the certificate's poses.
DISMANTLE_API std::optional<std::string> independent_objection(const Certificate& certificate,
                                                               const SeparationQuery& query, const RunContext& context);

}  // namespace dismantle
