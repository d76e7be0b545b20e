/// When the engine asks immobility provers: the parameters of the section `immobility:` beside the list of provers.
#pragma once

#include "dismantle/export.h"
#include "dismantle/parameters.h"

namespace dismantle {

struct ProofOptions {
  unsigned low_effort_depth = 3;
  unsigned medium_effort_depth = 4;
  double reduced_tolerance = 0.5;
  unsigned final_parts = 8;
  DISMANTLE_API static void describe(Schema<ProofOptions>& s);
};

}  // namespace dismantle
