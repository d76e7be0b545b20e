#include "dismantle/plugin.h"

#include "random/random.h"

DISMANTLE_PLUGIN("dismantle.random", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::SequencePlanner, dismantle::Random, dismantle::RandomParameters>(
      "random", "Parts left in random order, drawn anew after each removal.", {.source = "baseline"});
}
