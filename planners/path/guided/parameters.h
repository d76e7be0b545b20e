/// Parameters of the guided path planner.
#pragma once

#include "dismantle/push/parameters.h"

namespace dismantle::guided {

struct Parameters {
  push::Motion motion = push::Motion::automatic;
  // Table 6.
  double time_step = 0.1;
  double force = 100;
  double similarity_translation = 0.05;
  double similarity_rotation = 0.5;
  bool proposals = true;
  bool twists = true;
  bool novelty = true;
  bool diagonals = true;
  std::int64_t intermediate = 256;
  double thinning = 1e-4;
  std::int64_t max_refusals = 8;
  std::int64_t translation_nodes = 24;
  std::int64_t rotation_nodes = 8;
  std::int64_t lead_looks = 4'000;
  std::int64_t lead_cells = 500'000;
  std::int64_t squeeze_looks = 20'000;
  std::int64_t forest_after = 30'000;
  std::int64_t forest_steps = 1'500'000;

  static void describe(Schema<Parameters>& s) {
    push::describe_search(s);
    s.add("proposals", &Parameters::proposals,
          {.doc =
               "Translating, push first along directions that the contacts leave free, then along the axes, then along "
               "free directions while leaning on a wall."});
    s.add("twists", &Parameters::twists,
          {.doc = "Turning, first along the screw motions that the surfaces in contact leave free."});
    s.add(
        "novelty", &Parameters::novelty,
        {.doc =
             "Search first from states in places that were not searched from before; off: first come, first served."});
    push::describe_effort(s);
    s.add("lead_looks", &Parameters::lead_looks,
          {.unit = "1",
           .min = 0,
           .max = 1e12,
           .doc = "Under `motion: auto`: where free space leads out, a walk along it, given up after so many looks at "
                  "poses without progress, and some detours; one look takes 1000 distances, cheaper ones count as a "
                  "part of one, a quarter at least. Under a depth limit of 2 (then a half of it) or more it comes "
                  "before pushes, but below 4 not for what is larger than half of what stays; without a limit after "
                  "as many steps as before a forest, or, of what is thinner than its overlaps, a tenth. 0: none."});
    s.add("lead_cells", &Parameters::lead_cells,
          {.unit = "1",
           .min = 1000,
           .max = 1e8,
           .doc = "About so many cells are laid over the box of the still parts to find what is free."});
    s.add("squeeze_looks", &Parameters::squeeze_looks,
          {.unit = "1",
           .min = 0,
           .max = 1e12,
           .doc = "Under `motion: auto`: where pushes are in vain, a walk as in `squeeze` that looks at so many poses; "
                  "under a depth limit of 3 to 7 a half of it for each level below 8. 0: none."});
    s.add("forest_after", &Parameters::forest_after,
          {.unit = "1",
           .min = 1,
           .max = 1e12,
           .doc = "Under `motion: auto` and no depth limit: simulated steps after which a forest as in `tunnel_forest` "
                  "begins to take turns with the search over pushes; each turn is twice as long as the last."});
    s.add("forest_steps", &Parameters::forest_steps,
          {.unit = "1",
           .min = 0,
           .max = 1e12,
           .doc = "Simulated steps after which the forest is given up; 0: no forest at all."});
  }

  push::Tactics tactics() const {
    push::Tactics t = push::tactics_of(*this);
    t.own_axes = true;
    t.novelty = novelty;
    t.first_rank = 1;  // what the contacts leave free and the axes; then screws
    t.turning_lag = 1;
    if (proposals) t.translating.push_back(push::Stage::free);
    t.translating.push_back(push::Stage::axes);
    if (proposals) t.translating.push_back(push::Stage::leaning);
    if (twists) t.turning = {push::Stage::twists, push::Stage::leaning};
    t.turning.push_back(push::Stage::axes);
    if (diagonals) {
      t.translating.push_back(push::Stage::diagonals);
      t.turning.push_back(push::Stage::screws);
    }
    return t;
  }
};

}  // namespace dismantle::guided
