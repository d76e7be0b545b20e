/// When the engine asks immobility provers: the parameters of the section `immobility:` beside the list of provers.
#pragma once

#include <cstdint>

#include "dismantle/export.h"
#include "dismantle/parameters.h"

namespace dismantle {

/// When immobility provers are asked. All are advanced parameters.
struct ProofOptions {
  /// Cheap proofs are tried for searches of at least this depth, and for searches without a limit.
  unsigned low_effort_depth = 3;
  /// Expensive proofs about one part against one other are tried for searches of at least this depth, and for searches
  /// without a limit.
  unsigned medium_effort_depth = 4;
  /// Steps and state checks that a search spends before cheap proofs are tried; about the cost of these proofs. If the
  /// search ends earlier without a path, they are tried then.
  std::int64_t low_effort_steps = 2'000;
  std::int64_t medium_effort_steps = 20'000;  ///< As low_effort_steps, for expensive proofs.
  std::int64_t high_effort_steps = 30'000;   ///< As low_effort_steps, for the most expensive proofs about a pair.
  /// Share of the tolerance for which the last proofs are tried first. With a smaller tolerance more can be proved, but
  /// the proof covers fewer motions.
  double reduced_tolerance = 0.5;
  /// Maximum number of parts for which proofs are tried at the end of a run, up to a minute each. 0 = none.
  unsigned final_parts = 8;
  /// Share of the time left until the deadline that one of the most expensive proofs may take. Without a deadline they
  /// are limited by counts only.
  double deadline_share = 0.25;
  DISMANTLE_API static void describe(Schema<ProofOptions>& s);
};

}  // namespace dismantle
