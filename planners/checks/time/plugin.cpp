#include "dismantle/plugin.h"

#include "assembly_time.h"

DISMANTLE_PLUGIN("dismantle.time", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::StepCheck, dismantle::checks::Time, dismantle::checks::TimeParameters>(
      "time", "Adds the seconds that the steps take by hand.",
      {.source = "estimated times for manual handling and insertion; Boothroyd, Dewhurst and Knight 2002"});
}
