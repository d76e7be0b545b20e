#include "dismantle/plugin.h"

#include "covers.h"

DISMANTLE_PLUGIN("dismantle.covers", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::StepCheck, dismantle::checks::Covers>(
      "covers", "Small parts are put in before the larger parts that cover them.", {.source = "own"});
}
