/// Parameters that all planners searching over pushes have.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/path/shared_parameters.h"
#include "dismantle/push/tactics.h"

namespace dismantle::push {

/// A planner's own struct derives from this one.
struct SearchParameters {
  Motion motion = Motion::automatic;
  // Table 6.
  double time_step = 0.1;
  double force = 100;
  double similarity_translation = 0.05;
  double similarity_rotation = 0.5;
  // Beyond Algorithm 1; see the README of bfs.
  bool diagonals = true;
  std::int64_t intermediate = 256;
  double thinning = 1e-4;
  std::int64_t max_refusals = 8;
  std::int64_t translation_nodes = 24;
  std::int64_t rotation_nodes = 8;
};

/// Declares the first of them, for a struct that derives from SearchParameters.
template <class P>
void describe_search(Schema<P>& s) {
  using path::inherited;
  s.template add_choice<Motion>("motion", inherited<P>(&SearchParameters::motion),
                                {{"translation", Motion::translation, "forces only, orientation locked"},
                                 {"rotation", Motion::rotation, "forces and torques in SE(3)"},
                                 {"auto", Motion::automatic, "by translation and by rotation, in turns"}},
                                "State space of the search (section 4.2).");
  s.add("time_step", inherited<P>(&SearchParameters::time_step),
        {.unit = "s",
         .min = 1e-3,
         .max = 10,
         .doc = "Planning time step: an action runs so long between two looks (table 6)."});
  s.add("force", inherited<P>(&SearchParameters::force),
        {.unit = "N",
         .min = 0,
         .min_open = true,
         .doc = "Force of each action; torques are this times the part's radius (table 6)."});
  s.add("similarity_translation", inherited<P>(&SearchParameters::similarity_translation),
        {.unit = "unit", .min = 0, .min_open = true, .doc = "States nearer than this are similar (table 6)."});
  s.add("similarity_rotation", inherited<P>(&SearchParameters::similarity_rotation),
        {.unit = "rad",
         .min = 0,
         .max = 3.2,
         .min_open = true,
         .doc = "... if turned by less than this, too (table 6)."});
}

/// Declares the others; they come after the actions of the planner itself.
template <class P>
void describe_effort(Schema<P>& s) {
  using path::inherited;
  s.add("diagonals", inherited<P>(&SearchParameters::diagonals),
        {.doc =
             "When the unit actions are exhausted, also push along the 20 diagonals; turning, turn and pull at once."});
  s.add(
      "intermediate", inherited<P>(&SearchParameters::intermediate),
      {.unit = "1",
       .min = 0,
       .max = 1e6,
       .doc = "States in the middle of runs to search from when their ends are exhausted (turning: any number above 0 "
              "means all of them, after the ends of the same depth)."});
  path::add_thinning(s, inherited<P>(&SearchParameters::thinning));
  s.add("max_refusals", inherited<P>(&SearchParameters::max_refusals),
        {.unit = "1", .min = 0, .doc = "Paths that the verifier may refuse before the search gives up."});
  s.add("translation_nodes", inherited<P>(&SearchParameters::translation_nodes),
        {.unit = "1",
         .min = 1,
         .doc = "Under `motion: auto` and a depth limit: states searched by translations per level of depth."});
  s.add("rotation_nodes", inherited<P>(&SearchParameters::rotation_nodes),
        {.unit = "1",
         .min = 1,
         .doc = "Under `motion: auto` and a depth limit: states searched with rotation per level of depth."});
}

inline Tactics tactics_of(const SearchParameters& p) {
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

/// The last stages of both kinds.
inline void add_diagonals(Tactics& t) {
  t.translating.push_back(Stage::diagonals);
  t.turning.push_back(Stage::screws);
}

}  // namespace dismantle::push
