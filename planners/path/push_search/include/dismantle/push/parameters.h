/// Parameters that all planners searching over pushes have: declared and handed on in one place.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/push/tactics.h"

namespace dismantle::push {

/// P has the members; their defaults are its own.
template <class P>
void describe_search(Schema<P>& s) {
  s.template add_choice<Motion>("motion", &P::motion,
                                {{"translation", Motion::translation, "forces only, orientation locked"},
                                 {"rotation", Motion::rotation, "forces and torques in SE(3)"},
                                 {"auto", Motion::automatic, "by translation and by rotation, in turns"}},
                                "State space of the search (section 4.2).");
  s.add("time_step", &P::time_step,
        {.unit = "s",
         .min = 1e-3,
         .max = 10,
         .doc = "Planning time step: an action runs so long between two looks (table 6)."});
  s.add("force", &P::force,
        {.unit = "N",
         .min = 0,
         .min_open = true,
         .doc = "Force of each action; torques are this times the part's radius (table 6)."});
  s.add("similarity_translation", &P::similarity_translation,
        {.unit = "unit", .min = 0, .min_open = true, .doc = "States nearer than this are similar (table 6)."});
  s.add("similarity_rotation", &P::similarity_rotation,
        {.unit = "rad",
         .min = 0,
         .max = 3.2,
         .min_open = true,
         .doc = "... if turned by less than this, too (table 6)."});
}

/// What comes after the actions of the planner itself.
template <class P>
void describe_effort(Schema<P>& s) {
  s.add("diagonals", &P::diagonals,
        {.doc =
             "When the unit actions are exhausted, also push along the 20 diagonals; turning, turn and pull at once."});
  s.add(
      "intermediate", &P::intermediate,
      {.unit = "1",
       .min = 0,
       .max = 1e6,
       .doc = "States in the middle of runs to search from when their ends are exhausted (turning: any number above 0 "
              "means all of them, after the ends of the same depth)."});
  s.add("thinning", &P::thinning,
        {.unit = "unit",
         .min = 0,
         .max = 0.01,
         .doc = "Poses that the rest of the path reproduces this closely are dropped."});
  s.add("max_refusals", &P::max_refusals,
        {.unit = "1", .min = 0, .doc = "Paths that the verifier may refuse before the search gives up."});
  s.add("translation_nodes", &P::translation_nodes,
        {.unit = "1",
         .min = 1,
         .doc = "Under `motion: auto` and a depth limit: states searched by translations per level of depth."});
  s.add("rotation_nodes", &P::rotation_nodes,
        {.unit = "1",
         .min = 1,
         .doc = "Under `motion: auto` and a depth limit: states searched with rotation per level of depth."});
}

template <class P>
Tactics tactics_of(const P& p) {
  Tactics t;
  t.motion = p.motion;
  t.time_step = p.time_step;
  t.force = p.force;
  t.similarity_translation = p.similarity_translation;
  t.similarity_rotation = p.similarity_rotation;
  t.intermediate = p.intermediate;
  t.thinning = p.thinning;
  t.max_refusals = p.max_refusals;
  t.translation_nodes = p.translation_nodes;
  t.rotation_nodes = p.rotation_nodes;
  return t;
}

}  // namespace dismantle::push
