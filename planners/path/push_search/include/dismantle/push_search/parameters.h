/// Declares the parameters of the planners that use the push search.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/push_search/tactics.h"

namespace dismantle::push {

/// Declares the parameters of the search, for a struct that derives from SearchParameters.
template <class P>
void describe_search(Schema<P>& s) {
  s.template add_choice<Motion>("motion", &SearchParameters::motion,
                                {{"translation", Motion::translation, "forces only, orientation locked"},
                                 {"rotation", Motion::rotation, "forces and torques in SE(3)"},
                                 {"auto", Motion::automatic, "by translation and by rotation, in turns"}},
                                "State space of the search (section 4.2).");
  s.add("time_step", &SearchParameters::time_step,
        {.unit = "s",
         .min = 1e-3,
         .max = 10,
         .doc = "Planning time step: time for which an action runs before the state is examined (table 6)."});
  s.add("force", &SearchParameters::force,
        {.unit = "N",
         .min = 0,
         .min_open = true,
         .doc = "Force of each action; torques are this times the part's radius (table 6)."});
  s.add("similarity_translation", &SearchParameters::similarity_translation,
        {.unit = "unit", .min = 0, .min_open = true, .doc = "States nearer than this are similar (table 6)."});
  s.add("similarity_rotation", &SearchParameters::similarity_rotation,
        {.unit = "rad",
         .min = 0,
         .max = 3.2,
         .min_open = true,
         .doc = "States are similar if their orientations also differ by less than this (table 6)."});
  s.add("diagonals", &SearchParameters::diagonals,
        {.doc = "When the unit actions are exhausted, also push along the 20 diagonals; with rotation, combine a "
                "torque with a force along its axis."});
  s.advanced("intermediate", &SearchParameters::intermediate, {0, 1e6});
  s.advanced("end_similarity", &SearchParameters::end_similarity, {1e-3, 1});
  s.advanced("middle_lag", &SearchParameters::middle_lag, {0, 100});
  s.advanced("thinning", &SearchParameters::thinning, {0, 1});
  s.advanced("max_refusals", &SearchParameters::max_refusals, {0});
  s.advanced("translation_nodes", &SearchParameters::translation_nodes, {1});
  s.advanced("rotation_nodes", &SearchParameters::rotation_nodes, {1});
  s.advanced("level_steps", &SearchParameters::level_steps, {1, 1e12});
  s.advanced("clearance", &SearchParameters::clearance, {0, 100});
  s.advanced("touch_distance", &SearchParameters::touch_distance, {1e-3, 0.9});
}

/// Declares the parameters of the actions that contacts propose.
template <class P>
void describe_proposals(Schema<P>& s) {
  s.advanced("place_similarity", &ProposalParameters::place_similarity, {1, 1000});
  s.advanced("facet_angle", &ProposalParameters::facet_angle, {1e-4, 0.5});
  s.advanced("free_directions", &ProposalParameters::free_directions, {1, 1000});
  s.advanced("lean", &ProposalParameters::lean, {0.01, 1});
  s.advanced("glide_step", &ProposalParameters::glide_step, {1e-5, 0.5});
  s.advanced("glide_growth", &ProposalParameters::glide_growth, {0, 1});
  s.advanced("glide_kept", &ProposalParameters::glide_kept, {0.01, 1});
}

/// Adds the last stages of translation and of rotation.
inline void add_diagonals(Tactics& t) {
  t.translating.push_back(Stage::diagonals);
  t.rotating.push_back(Stage::screws);
}

}  // namespace dismantle::push
