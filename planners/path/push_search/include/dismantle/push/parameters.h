/// Declares the parameters of the planners that use the push search.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/path/shared_parameters.h"
#include "dismantle/push/tactics.h"

namespace dismantle::push {

/// Declares the first group of parameters, for a struct that derives from SearchParameters.
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
         .doc = "Planning time step: time for which an action runs before the state is examined (table 6)."});
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
         .doc = "States are similar if their orientations also differ by less than this (table 6)."});
}

/// Declares the other search parameters. Call it after the planner has declared its own kinds of actions.
template <class P>
void describe_effort(Schema<P>& s) {
  using path::inherited;
  s.add("diagonals", inherited<P>(&SearchParameters::diagonals),
        {.doc = "When the unit actions are exhausted, also push along the 20 diagonals; with rotation, combine a "
                "torque with "
                "a force along its axis."});
  s.add("intermediate", inherited<P>(&SearchParameters::intermediate),
        {.unit = "1",
         .min = 0,
         .max = 1e6,
         .doc = "Up to this many states in the middle of runs are expanded when the ends of runs are exhausted (with "
                "rotation: any number above 0 means all of them, after the ends of the same depth)."});
  s.add("end_similarity", inherited<P>(&SearchParameters::end_similarity),
        {.unit = "similarity",
         .min = 1e-3,
         .max = 1,
         .doc = "Advanced. An end of a run is new unless it is nearer to a known state than this share of "
                "`similarity_translation` and `similarity_rotation`. Smaller: more states are kept."});
  s.add("middle_lag", inherited<P>(&SearchParameters::middle_lag),
        {.unit = "1",
         .min = 0,
         .max = 100,
         .doc = "Advanced. Number of stages of actions by which two kinds of states are delayed: those in the middle "
                "of runs and, if parts move independently, those in which only one part has moved."});
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
  s.add(
      "level_steps", inherited<P>(&SearchParameters::level_steps),
      {.unit = "1",
       .min = 1,
       .max = 1e12,
       .doc = "Advanced. Under `motion: auto` and a depth limit: simulated steps and state checks per level of depth, "
              "by translation and again with rotation. Larger: parts that can move far in their play are searched "
              "longer."});
  s.add("clearance", inherited<P>(&SearchParameters::clearance),
        {.unit = "max_penetration",
         .min = 0,
         .max = 100,
         .doc = "Advanced. Distance by which a part is moved away from its contacts, where possible, before it follows "
                "a screw, and along a path on which parts drive each other. As a multiple of "
                "verify.max_penetration."});
  s.add("touch_distance", inherited<P>(&SearchParameters::touch_distance),
        {.unit = "max_penetration",
         .min = 1e-3,
         .max = 0.9,
         .doc = "Advanced. Surfaces nearer than this count as touching, and penetration up to this counts as zero. As "
                "a share of verify.max_penetration."});
}

/// Declares the parameters of the actions that contacts propose.
template <class P>
void describe_proposals(Schema<P>& s) {
  using path::inherited;
  s.add("place_similarity", inherited<P>(&ProposalParameters::place_similarity),
        {.unit = "similarity_translation",
         .min = 1,
         .max = 1000,
         .doc = "Advanced. With `novelty`, states nearer to each other than this count as one place. As a multiple of "
                "`similarity_translation`."});
  s.add("facet_angle", inherited<P>(&ProposalParameters::facet_angle),
        {.unit = "rad",
         .min = 1e-4,
         .max = 0.5,
         .doc =
             "Advanced. Normals and directions that differ by less than this angle count as equal, and a direction may "
             "point into a contact by up to this angle. Set it to more than half the angle between two facets of a "
             "round fit."});
  s.add("free_directions", inherited<P>(&ProposalParameters::free_directions),
        {.unit = "1",
         .min = 1,
         .max = 1000,
         .doc = "Advanced. Largest number of directions per state along which the contacts let the part slide. Those "
                "with the shortest way out come first."});
  s.add("lean", inherited<P>(&ProposalParameters::lean),
        {.unit = "1",
         .min = 0.01,
         .max = 1,
         .doc = "Advanced. Share of `force` that presses a part against a wall while it slides along the wall, or "
                "along its axis while it turns."});
  s.add("glide_step", inherited<P>(&ProposalParameters::glide_step),
        {.unit = "max_penetration",
         .min = 1,
         .max = 1000,
         .doc = "Advanced. First distance between two state checks along a screw, and distance between the poses of "
                "its path, as a multiple of verify.max_penetration. Larger: fewer checks, but thin obstacles are "
                "missed, and the verifier refuses the path."});
  s.add("glide_growth", inherited<P>(&ProposalParameters::glide_growth),
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc = "Advanced. Distance between two state checks along a screw, as a share of the clear length so far. "
                "0: always `glide_step`."});
  s.add("glide_kept", inherited<P>(&ProposalParameters::glide_kept),
        {.unit = "1",
         .min = 0.01,
         .max = 1,
         .doc = "Advanced. A blocked screw is fitted again at this share of its clear length."});
}

/// Adds the last stages of translation and of rotation.
inline void add_diagonals(Tactics& t) {
  t.translating.push_back(Stage::diagonals);
  t.turning.push_back(Stage::screws);
}

}  // namespace dismantle::push
