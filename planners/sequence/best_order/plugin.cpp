#include "dismantle/plugin.h"

#include "best_order/best_order.h"

DISMANTLE_PLUGIN("dismantle.best_order", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::SequencePlanner, dismantle::BestOrder, dismantle::BestOrderParameters>(
      "best_order", "Takes the plan of another sequence planner and looks for the order that the objective likes best.",
      {.source = "own; A* over sets of parts with counted effort, then beam search and windows"});
}
