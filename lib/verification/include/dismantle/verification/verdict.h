/// What a path planner is told of a check.
#pragma once

#include "dismantle/path_planner.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// Accepted when the motion is valid; otherwise with the witness, if there is one. `instant` is the one at which the
/// segment at fault begins; `reason` is left to whoever knows the names.
inline Verdict verdict_of(const MotionCheck& check) {
  Verdict verdict;
  verdict.accepted = check.valid;
  if (!check.violation) return verdict;
  verdict.has_witness = true;
  verdict.part = check.violation->part;
  verdict.other = check.violation->other;
  verdict.point = check.violation->point;
  verdict.instant = check.violation->segment;
  return verdict;
}

}  // namespace dismantle
