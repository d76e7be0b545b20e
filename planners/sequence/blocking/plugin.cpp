#include "dismantle/plugin.h"

#include "blocking/blocking.h"

DISMANTLE_PLUGIN("dismantle.blocking", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::SequencePlanner, dismantle::Blocking, dismantle::BlockingParameters>(
      "blocking", "Blocking graphs: free parts, free groups, translations part-way; path searches only for the rest.",
      {.source = "directional blocking graphs after Wilson and Latombe 1994"});
}
