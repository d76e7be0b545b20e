/// How a push search goes about it: what the planners that share it differ in.
#pragma once

#include <cstdint>
#include <vector>

#include "dismantle/path/motion.h"

namespace dismantle::push {

using path::Motion;

/// What to push with, from stage to stage; a state is given one stage at a time.
enum class Stage {
  twists,     ///< screw motions that the surfaces in contact leave free; in SE(3) only
  free,       ///< directions that the contacts leave free
  axes,       ///< forces along three axes, both ways; in SE(3) torques about them, too
  leaning,    ///< free directions while leaning on a wall beside
  diagonals,  ///< forces along the 20 diagonals
  screws,     ///< a torque and a force along its axis at once; in SE(3) only
  // For queries in which each part moves in its own way (Goal::any_of):
  one_driven,  ///< a force along one of three axes (in SE(3) also a torque about
               ///< it) on one part; contact drags others
  two_along,   ///< on two parts at once, along the same axis, in all combinations
  two_across,  ///< on two parts at once, along different axes
};

struct Tactics {
  Motion motion = Motion::automatic;
  double time_step = 0.1;                ///< s, between two looks
  double force = 100;                    ///< N
  double similarity_translation = 0.05;  ///< assembly units
  double similarity_rotation = 0.5;      ///< rad
  std::vector<Stage> translating, turning;
  /// Where each part moves in its own way, translating and turning. How many actions there are grows with the square of
  /// the number of parts, not exponentially: who is given no wrench of its own follows.
  std::vector<Stage> each_its_way{Stage::one_driven, Stage::two_along, Stage::two_across};
  /// Axes of the parts themselves (frame.h), so that nothing depends on how the assembly lies; else the world's.
  bool own_axes = false;
  bool novelty = false;
  std::int64_t intermediate = 0;  ///< states in the middle of runs that may be searched from, see README.md
  double thinning = 1e-4;         ///< assembly units
  std::int64_t max_refusals = 8;
  /// motion auto under a depth limit: states searched from per level of depth.
  std::int64_t translation_nodes = 24, rotation_nodes = 8;
  /// The same where each part moves in its own way: simulated steps per level of depth, in each motion space.
  std::int64_t simultaneous_steps = 2000;
  /// motion auto without one: rank to which translation is searched first, and by how much less rotation is after it.
  unsigned first_rank = 0, turning_lag = 0;
};

}  // namespace dismantle::push
