#include "dismantle/plugin.h"

#include "least_cut/least_cut.h"

DISMANTLE_PLUGIN("dismantle.least_cut", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::SequencePlanner, dismantle::LeastCut, dismantle::LeastCutParameters>(
      "least_cut", "Forced steps: takes out what no verified path is known for, where it cuts in least.",
      {.source = "own"});
}
