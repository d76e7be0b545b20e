#include "dismantle/plugin.h"

#include "reorientations.h"

DISMANTLE_PLUGIN("dismantle.reorientations", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::StepCheck, dismantle::checks::Reorientations, dismantle::checks::ReorientationsParameters>(
      "reorientations", "Counts how often the whole assembly is turned.",
      {.source = "number of reorientations; Baldwin et al. 1991"});
}
