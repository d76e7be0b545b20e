#include "dismantle/plugin.h"

#include "blocking/blocking.h"

DISMANTLE_PLUGIN("dismantle.blocking", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::SequencePlanner, dismantle::Blocking, dismantle::BlockingParams>(
      "blocking", "By what is in whose way: free parts, free groups, slides part-way; searches only for the rest.",
      {.source = "directional blocking graphs after Wilson and Latombe 1994"});
}
