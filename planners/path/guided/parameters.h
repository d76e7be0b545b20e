/// Parameters of the guided path planner.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/push/tactics.h"

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
  std::int64_t forest_after = 30'000;
  std::int64_t forest_steps = 1'500'000;

  static void describe(Schema<Parameters>& s) {
    s.add_choice<push::Motion>("motion", &Parameters::motion,
                               {{"translation", push::Motion::translation, "forces only, orientation locked"},
                                {"rotation", push::Motion::rotation, "forces and torques in SE(3)"},
                                {"auto", push::Motion::automatic, "by translation and by rotation, in turns"}},
                               "State space of the search (section 4.2).");
    s.add("time_step", &Parameters::time_step,
          {.unit = "s",
           .min = 1e-3,
           .max = 10,
           .doc = "Planning time step: an action runs so long between two looks (table 6)."});
    s.add("force", &Parameters::force,
          {.unit = "N",
           .min = 0,
           .min_open = true,
           .doc = "Force of each action; torques are this times the part's radius (table 6)."});
    s.add("similarity_translation", &Parameters::similarity_translation,
          {.unit = "unit", .min = 0, .min_open = true, .doc = "States nearer than this are similar (table 6)."});
    s.add("similarity_rotation", &Parameters::similarity_rotation,
          {.unit = "rad",
           .min = 0,
           .max = 3.2,
           .min_open = true,
           .doc = "... if turned by less than this, too (table 6)."});
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
    s.add(
        "diagonals", &Parameters::diagonals,
        {.doc =
             "When the unit actions are exhausted, also push along the 20 diagonals; turning, turn and pull at once."});
    s.add("intermediate", &Parameters::intermediate,
          {.unit = "1",
           .min = 0,
           .max = 1e6,
           .doc =
               "States in the middle of runs to search from when their ends are exhausted (turning: any number above 0 "
               "means all of them, after the ends of the same depth)."});
    s.add("thinning", &Parameters::thinning,
          {.unit = "unit",
           .min = 0,
           .max = 0.01,
           .doc = "Poses that the rest of the path reproduces this closely are dropped."});
    s.add("max_refusals", &Parameters::max_refusals,
          {.unit = "1", .min = 0, .doc = "Paths that the verifier may refuse before the search gives up."});
    s.add("translation_nodes", &Parameters::translation_nodes,
          {.unit = "1",
           .min = 1,
           .doc = "Under `motion: auto` and a depth limit: states searched by translations per level of depth."});
    s.add("rotation_nodes", &Parameters::rotation_nodes,
          {.unit = "1",
           .min = 1,
           .doc = "Under `motion: auto` and a depth limit: states searched with rotation per level of depth."});
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
    push::Tactics t;
    t.motion = motion;
    t.time_step = time_step;
    t.force = force;
    t.similarity_translation = similarity_translation;
    t.similarity_rotation = similarity_rotation;
    t.intermediate = intermediate;
    t.thinning = thinning;
    t.max_refusals = max_refusals;
    t.translation_nodes = translation_nodes;
    t.rotation_nodes = rotation_nodes;
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
