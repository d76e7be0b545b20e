#include "dismantle/plugin.h"

#include "chain/chain.h"

DISMANTLE_PLUGIN("dismantle.chain", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::SequencePlanner, dismantle::Chain, dismantle::ChainParameters>(
      "chain", "Several sequence planners: each takes apart what those before it have left.", {.source = "own"});
}
