#include "dismantle/plugin.h"

#include "hook/hook.h"

DISMANTLE_PLUGIN("dismantle.hook", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::ImmobilityProver, dismantle::immobility::Hook, dismantle::immobility::HookParameters>(
      "hook", "One part goes through a hole of the other, between two bends that cannot pass it.",
      {.source = "parity of crossings; a cover of all positions and directions by cells"});
}
