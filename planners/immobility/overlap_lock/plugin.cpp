#include "dismantle/plugin.h"

#include "overlap_lock/overlap_lock.h"

DISMANTLE_PLUGIN("dismantle.overlap_lock", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::ImmobilityProver, dismantle::immobility::OverlapLock, dismantle::immobility::OverlapLockParameters>(
      "overlap_lock", "Two parts overlap when assembled, deeper than any motion may: a point that lies in both.",
      {.source = "a point that lies in both parts when assembled"});
}
