/// When the engine asks immobility provers: the parameters of the section `immobility:` beside the list of provers.
#pragma once

#include <cstdint>

#include "dismantle/export.h"
#include "dismantle/parameters.h"

namespace dismantle {

/// When immobility provers are asked; defaults and docs are in describe().
struct ProofOptions {
  unsigned low_effort_depth = 3;
  unsigned medium_effort_depth = 4;
  std::int64_t low_effort_steps = 2'000;
  std::int64_t medium_effort_steps = 20'000;
  double reduced_tolerance = 0.5;
  unsigned final_parts = 8;
  double deadline_share = 0.25;
  DISMANTLE_API static void describe(Schema<ProofOptions>& s);
};

}  // namespace dismantle
