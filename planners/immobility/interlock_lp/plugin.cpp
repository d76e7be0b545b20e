#include "dismantle/plugin.h"

#include "interlock_lp/interlock_lp.h"

DISMANTLE_PLUGIN("dismantle.interlock_lp", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::ImmobilityProver, dismantle::immobility::InterlockLp, dismantle::immobility::InterlockLpParameters>(
      "interlock_lp",
      "Three and more parts that hold each other in place: linear bounds of the motions of all of them.",
      {.source = "linear programs over half spaces of poses, with bounds of what is not linear"});
}
