/// Parameters of a push search, and the stages of actions in which the planners that share it differ.
#pragma once

#include <cstdint>
#include <vector>

#include "dismantle/path/motion.h"

namespace dismantle::push {

using path::Motion;

/// Kinds of actions; a state is given one stage at a time.
enum class Stage {
  twists,     ///< screw motions that the surfaces in contact leave free; in SE(3) only
  free,       ///< directions that the contacts leave free
  axes,       ///< forces along three axes, both ways; in SE(3) torques about them, too
  leaning,    ///< free directions while pressing against a wall beside
  diagonals,  ///< forces along the 20 diagonals
  screws,     ///< a torque and a force along its axis together; in SE(3) only
  // For queries in which each part moves in its own way (Goal::any_of):
  one_driven,  ///< a force along one of three axes (in SE(3) also a torque about
               ///< it) on one part; contact drags others
  two_along,   ///< on two parts simultaneously, along the same axis, in all combinations
  two_across,  ///< on two parts simultaneously, along different axes
};

/// Parameters that all planners searching over pushes have; a planner's own struct derives from this one.
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

/// What the planners that share the search set beside the parameters.
struct Tactics : SearchParameters, ProposalParameters {
  std::vector<Stage> translating, turning;
  /// Where each part moves in its own way, translating and turning. How many actions there are grows with the square of
  /// the number of parts, not exponentially: a part that is given no wrench of its own is dragged along.
  std::vector<Stage> each_its_way{Stage::one_driven, Stage::two_along, Stage::two_across};
  /// Axes of the parts themselves (frame.h), so that nothing depends on how the assembly lies; else the world's.
  bool own_axes = false;
  bool novelty = false;
  /// motion auto without a depth limit: rank to which translation is searched first, and by how much less rotation is
  /// after it.
  unsigned first_rank = 0, turning_lag = 0;
};

}  // namespace dismantle::push
