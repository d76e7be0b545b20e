#include "dismantle/plugin.h"

#include "ndbg/ndbg.h"

DISMANTLE_PLUGIN("dismantle.ndbg", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::SequencePlanner, dismantle::Ndbg, dismantle::NdbgParameters>(
      "ndbg", "Non-directional blocking graphs alone: parts and groups that a translation removes.",
      {.source = "Wilson and Latombe 1994"});
}
