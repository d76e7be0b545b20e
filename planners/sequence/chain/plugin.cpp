#include "chain/chain.h"
#include "dismantle/plugin.h"

DISMANTLE_PLUGIN("dismantle.chain", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::SequencePlanner, dismantle::Chain, dismantle::ChainParams>(
      "chain", "Several sequence planners: each takes apart what those before it have left.", {.source = "own"});
}
