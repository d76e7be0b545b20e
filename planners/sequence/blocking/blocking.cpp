#include "blocking/blocking.h"

#include "blocking/taking_apart.h"

namespace dismantle {

void BlockingParams::describe(Schema<BlockingParams>& schema) {
  schema.add_choice("order", &BlockingParams::order,
                    {{"small_first", PartOrder::small_first, "ascending volume: screws and pins before the housing"},
                     {"as_given", PartOrder::as_given, "as the assembly lists its parts"},
                     {"large_first", PartOrder::large_first, "descending volume"}},
                    "Order in which parts are taken when several are free.");
  schema.add(
      "straight", &BlockingParams::straight,
      {.doc = "Take parts out along straight lines wherever the judge finds nothing in the way. Off: every way is "
              "searched for by the path planner."});
  schema.add("groups", &BlockingParams::groups,
             {.doc = "When no single part is free, take out the smallest group that is, and take it apart by itself."});
  schema.add("slide_states", &BlockingParams::slide_states,
             {.unit = "1",
              .min = 0,
              .max = 1e8,
              .doc = "When neither parts nor groups are free: largest number of states in the search for slides that "
                     "leave parts part-way (puzzles). 0 = no such search."});
  schema.add(
      "cages", &BlockingParams::cages,
      {.doc = "Then look whether two parts provably hold each other (a ring in a groove, a bent bar in a hole), and "
              "move those as one. After vain searches: what has a flat piece, any two of which one was alone in the "
              "other's way, and groups of up to eight parts of which none can slide."});
  schema.add("turns", &BlockingParams::turns,
             {.doc = "Then turn parts about the axes of their round surfaces, and leave them turned where that frees "
                     "another part (latches)."});
  schema.add(
      "at_once", &BlockingParams::at_once,
      {.doc = "Then move two or three parts at once, each in its own way, where nobody else is in the way of one of "
              "them (interlocks). Needs a path planner that does so (bfs, contact_search, guided)."});
  schema.add("max_depth", &BlockingParams::max_depth,
             {.unit = "1",
              .min = 1,
              .max = 1e6,
              .doc = "Largest depth of the path searches. They go one action deeper whenever no part left. The search "
                     "for the ways "
                     "of the last two parts of a group has no limit."});
}

SequenceResult Blocking::plan(const Assembly& assembly, PathOracle& oracle, SequenceObserver& observer,
                              RunContext& context) {
  return blocking::TakingApart(params_, assembly, oracle, observer, context).run();
}

}  // namespace dismantle
