#include "dismantle/plugin.h"

#include "enclosed_ball/enclosed_ball.h"

DISMANTLE_PLUGIN("dismantle.enclosed_ball", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::ImmobilityProver, dismantle::immobility::EnclosedBall,
        dismantle::immobility::EnclosedBallParameters>(
      "enclosed_ball", "A part contains a ball that is too large for every way out between the parts around it.",
      {.source = "flooding of the free space of an inscribed ball"});
}
