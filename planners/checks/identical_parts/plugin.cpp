#include "dismantle/plugin.h"

#include "identical_parts.h"

DISMANTLE_PLUGIN("dismantle.identical_parts", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::StepCheck, dismantle::checks::IdenticalParts, dismantle::checks::IdenticalPartsParameters>(
      "identical_parts", "Counts interruptions between equal parts: screws are put in one after the other.",
      {.source = "own; parts are equal when they are congruent"});
}
