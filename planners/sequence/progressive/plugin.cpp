#include "dismantle/plugin.h"

#include "progressive/progressive.h"

DISMANTLE_PLUGIN("dismantle.progressive", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::SequencePlanner, dismantle::Progressive, dismantle::ProgressiveParameters>(
      "progressive", "Round by round over all parts left, one action deeper each round.",
      {.source = "Tian et al. 2022, Algorithm 2 (Prog. BFS)"});
}
