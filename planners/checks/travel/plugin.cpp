#include "dismantle/plugin.h"

#include "travel.h"

DISMANTLE_PLUGIN("dismantle.travel", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::StepCheck, dismantle::checks::Travel, dismantle::checks::TravelParameters>(
      "travel", "Adds the lengths of the ways that lead close past other parts.", {.source = "own"});
}
