/// Parameters of a push search, and its stages of actions. The planners that share the search differ in the stages.
#pragma once

#include <cstdint>
#include <vector>

#include "dismantle/path/motion.h"

namespace dismantle::push {

using path::Motion;

/// Kinds of actions. Each expansion of a state applies one stage.
enum class Stage {
  twists,     ///< screw motions that the surfaces in contact allow; in SE(3) only
  free,       ///< directions that the contacts allow
  axes,       ///< forces along three axes in both directions; in SE(3) also torques about them
  leaning,    ///< free directions while pressing against an adjacent wall
  diagonals,  ///< forces along the 20 diagonals
  screws,     ///< a torque combined with a force along its axis; in SE(3) only
  // For queries whose parts move independently (Goal::any_of):
  one_driven,  ///< a force along one of three axes (in SE(3) also a torque about
               ///< it) on one part; contact moves the others
  two_along,   ///< the same on two parts simultaneously, along one axis, in all combinations
  two_across,  ///< the same on two parts simultaneously, along different axes
};

/// Parameters common to all push searches. A planner's own parameter struct derives from this one.
struct SearchParameters {
  Motion motion = Motion::automatic;
  // Table 6.
  double time_step = 0.1;
  double force = 100;
  double similarity_translation = 0.05;
  double similarity_rotation = 0.5;
  // Extensions of Algorithm 1; see the README of bfs.
  bool diagonals = true;
  std::int64_t intermediate = 256;
  double thinning = 1e-4;
  std::int64_t max_refusals = 8;
  std::int64_t translation_nodes = 24;
  std::int64_t rotation_nodes = 8;
  std::int64_t level_steps = 2000;
  double end_similarity = 0.2;
  std::int64_t middle_lag = 2;
  double clearance = 2;
  double touch_distance = 0.1;
};

/// Parameters of the actions that contacts propose.
struct ProposalParameters {
  double place_similarity = 5;
  double facet_angle = 0.035;
  std::int64_t free_directions = 8;
  double lean = 0.5;
  double glide_step = 20;
  double glide_growth = 0.25;
  double glide_kept = 0.75;
};

/// Everything that a planner sets for the search: its parameters and its stages of actions.
struct Tactics : SearchParameters, ProposalParameters {
  std::vector<Stage> translating, turning;
  /// Stages if parts move independently, translating and turning. The number of actions grows with the square of the
  /// number of parts, not exponentially: at most two parts are driven, and contact moves the others.
  std::vector<Stage> each_its_way{Stage::one_driven, Stage::two_along, Stage::two_across};
  /// True: axes from the parts' own faces (frame.h), independent of the orientation of the assembly. False: world axes.
  bool own_axes = false;
  bool novelty = false;
  /// With `motion: auto` and no depth limit, translation is first searched up to `first_rank`. Rotation follows up to
  /// the rank of translation minus `turning_lag`.
  unsigned first_rank = 0, turning_lag = 0;
};

}  // namespace dismantle::push
