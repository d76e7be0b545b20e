#include "dismantle/plugin.h"

#include "disc/disc.h"

DISMANTLE_PLUGIN("dismantle.disc", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::ImmobilityProver, dismantle::immobility::Disc, dismantle::immobility::DiscParameters>(
      "disc", "A flat disc within the smaller part is in a chamber of the larger one and passes none of its openings.",
      {.source = "cell decomposition of the positions of the disc's centre"});
}
