#include "dismantle/plugin.h"

#include "queue/queue.h"

DISMANTLE_PLUGIN("dismantle.queue", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::SequencePlanner, dismantle::Queue, dismantle::QueueParameters>(
      "queue", "All parts left in turn, without depth limit.", {.source = "Tian et al. 2022, section 6.3 (Full BFS)"});
}
