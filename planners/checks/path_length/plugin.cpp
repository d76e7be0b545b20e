#include "dismantle/plugin.h"

#include "path_length.h"

DISMANTLE_PLUGIN("dismantle.path_length", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::StepCheck, dismantle::checks::PathLength>(
      "path_length", "Adds the lengths of the ways on which parts are put in.",
      {.source = "own"});
}
