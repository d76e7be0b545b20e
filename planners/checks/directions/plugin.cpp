#include "dismantle/plugin.h"

#include "directions.h"

DISMANTLE_PLUGIN("dismantle.directions", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::StepCheck, dismantle::checks::Directions, dismantle::checks::DirectionsParameters>(
      "directions", "Counts changes of the direction of insertion.",
      {.source = "number of changes of the assembly direction; De Fazio and Whitney 1987"});
}
