#include "dismantle/plugin.h"

#include "spool/spool.h"

DISMANTLE_PLUGIN("dismantle.spool", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::ImmobilityProver, dismantle::immobility::Spool, dismantle::immobility::SpoolParameters>(
      "spool",
      "One part goes through a hole of the other, between two rims that are wider than a circle about the hole.",
      {.source = "linking numbers and parity of crossings"});
}
