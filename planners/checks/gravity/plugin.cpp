#include "dismantle/plugin.h"

#include "gravity.h"

DISMANTLE_PLUGIN("dismantle.gravity", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::StepCheck, dismantle::checks::Gravity, dismantle::checks::GravityParameters>(
      "gravity", "Counts the parts that somebody has to hold so that what has been built stands.",
      {.source = "equilibrium with Coulomb friction; Livesley 1978, Kao et al. 2022"});
}
