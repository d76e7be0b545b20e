/// Parameters of a push search, and its stages of actions. The planners that share the search differ in the stages.
#pragma once

#include <cstdint>
#include <vector>

#include "dismantle/search/motion.h"

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
  /// Up to this many states in the middle of runs are expanded when the ends of runs are exhausted (with rotation: any
  /// number above 0 means all of them, after the ends of the same depth).
  std::int64_t intermediate = 256;
  /// Poses that the rest of the path reproduces to within this distance are dropped. As a share of
  /// verify.max_penetration.
  double thinning = 0.1;
  std::int64_t max_refusals = 8;  ///< Paths that the verifier may refuse before the search gives up.
  /// Under `motion: auto` and a depth limit: states searched by translations per level of depth.
  std::int64_t translation_nodes = 24;
  /// Under `motion: auto` and a depth limit: states searched with rotation per level of depth.
  std::int64_t rotation_nodes = 8;
  /// Under `motion: auto` and a depth limit: simulated steps and state checks per level of depth, by translation and
  /// again with rotation. Larger: parts that can move far in their play are searched longer.
  std::int64_t level_steps = 2000;
  /// An end of a run is new unless it is nearer to a known state than this share of `similarity_translation` and
  /// `similarity_rotation`. Smaller: more states are kept.
  double end_similarity = 0.2;
  /// Number of stages of actions by which two kinds of states are delayed: those in the middle of runs and, if parts
  /// move independently, those in which only one part has moved.
  std::int64_t middle_lag = 2;
  /// Distance by which a part is moved away from its contacts, where possible, before it follows a screw. As a multiple
  /// of verify.max_penetration; 0: to the middle of the room that there is, since the play of a fit does not depend on
  /// what the verifier tolerates.
  double clearance = 0;
  /// Surfaces nearer than this count as touching, and penetration up to this counts as zero. As a share of
  /// verify.max_penetration.
  double touch_distance = 0.1;
};

/// Parameters of the actions that contacts propose.
struct ProposalParameters {
  /// With `novelty`, states nearer to each other than this count as one place. As a multiple of
  /// `similarity_translation`.
  double place_similarity = 5;
  /// Normals and directions that differ by less than this angle count as equal, and a direction may point into a
  /// contact by up to this angle. Set it to more than half the angle between two facets of a round fit (rad).
  double facet_angle = 0.035;
  /// Largest number of directions per state along which the contacts let the part slide. Those with the shortest way
  /// out come first.
  std::int64_t free_directions = 8;
  /// Share of `force` that presses a part against a wall while it slides along the wall, or along its axis while it
  /// turns.
  double lean = 0.5;
  /// First distance between two state checks along a screw, and distance between the poses of its path, as a share of
  /// the way that separates the boxes of the parts for certain. Larger: fewer checks, but thin obstacles are missed,
  /// and the verifier refuses the path.
  double glide_step = 0.01;
  /// Distance between two state checks along a screw, as a share of the clear length so far. 0: always `glide_step`.
  double glide_growth = 0.25;
  double glide_kept = 0.75;  ///< A blocked screw is fitted again at this share of its clear length.
};

/// Everything that a planner sets for the search: its parameters and its stages of actions.
struct Tactics : SearchParameters, ProposalParameters {
  std::vector<Stage> translating, rotating;
  /// Stages if parts move independently, translating and rotating. The number of actions grows with the square of the
  /// number of parts, not exponentially: at most two parts are driven, and contact moves the others.
  std::vector<Stage> independent{Stage::one_driven, Stage::two_along, Stage::two_across};
  /// True: axes from the parts' own faces (frame.h), independent of the orientation of the assembly. False: world axes.
  bool own_axes = false;
  bool novelty = false;
  /// With `motion: auto` and no depth limit, translation is first searched up to `first_rank`. Rotation follows up to
  /// the rank of translation minus `rotation_lag`.
  unsigned first_rank = 0, rotation_lag = 0;
};

}  // namespace dismantle::push
