#include "dismantle/plugin.h"

#include "steps.h"

DISMANTLE_PLUGIN("dismantle.steps", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::StepCheck, dismantle::checks::Steps>("steps", "Counts steps.",
                                                        {.source = "depth of disassembly, EN 45554:2020"});
}
