#include "dismantle/plugin.h"

#include "state_based/state_based.h"

DISMANTLE_PLUGIN("dismantle.state_based", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::SequencePlanner, dismantle::StateBased, dismantle::StateBasedParameters>(
      "state_based", "Translations before rotations; motion states are kept; parts are chosen by their blockers.",
      {.source = "in the manner of Lei, Lipovetzky and Ehinger, AAAI 2025"});
}
