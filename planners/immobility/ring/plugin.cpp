#include "dismantle/plugin.h"

#include "ring/ring.h"

DISMANTLE_PLUGIN("dismantle.ring", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::ImmobilityProver, dismantle::immobility::Ring, dismantle::immobility::RingParameters>(
      "ring", "A ring of one part is in a chamber of the other, all of whose openings are narrower.",
      {.source = "linking numbers and parity of crossings"});
}
