#include "dismantle/plugin.h"

#include "base.h"

DISMANTLE_PLUGIN("dismantle.base", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::StepCheck, dismantle::checks::Base>(
      "base", "The part that everything is put on should be large, low and touch many parts.", {.source = "own"});
}
