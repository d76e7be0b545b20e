/// Parameters of the planner, by the strategy that uses them.
#pragma once

#include <cstdint>

#include "dismantle/parameters.h"
#include "one_by_one/one_by_one.h"

namespace dismantle {

namespace blocking {

/// Whether what leaves upwards goes first. `automatic`: in a `best_order`, where the program says `on`.
enum class Upwards { automatic, on, off };

/// Straight removals: free_part, target_first, and the pairwise relations that other strategies use.
struct StraightParameters {
  bool straight = true;
  /// Parts that leave straight up go first, then parts and groups that leave sideways, at last what leaves downwards:
  /// the base stays to the end.
  Upwards upwards = Upwards::automatic;
};

struct FreeGroupParameters {
  bool groups = true;
  /// Largest number of groups proposed to the verifier before other strategies are tried.
  unsigned group_proposals = 8;
};

struct RepeatedPathParameters {
  bool repeated_paths = true;
  /// Parts whose box edges differ by less than this share of the box diagonal also count as copies. 0 = only parts with
  /// the same triangles.
  double repeated_similarity = 0.02;
  unsigned repeated_refusals = 3;  ///< Number of refused proposals after which a part is left to the other strategies.
};

struct PartialTranslationParameters {
  std::int64_t translation_states = 60'000;
  /// The search is given up after the verifier has refused this number of translations.
  unsigned translation_refusals = 12;
  /// Largest number of pairs of edges that the first search for partial translations compares.
  double translation_work = 5e8;
  double translation_work_growth = 4;  ///< Factor on translation_work for every further depth of the path searches.
  double translation_inset = 0.3;  ///< Inset of the surfaces in this search, as a share of the verifier's tolerance.
  /// Shortest translation, as a multiple of verify.max_penetration. Smaller: more states.
  double translation_least_step = 5;
  /// Motions shorter than this only use up clearance: no such translation to contact is made, and simultaneous_motion
  /// does not count such a part as moved. As a multiple of verify.max_penetration.
  double play = 25;
  /// Largest number of edges between flat faces of a part with which the search runs. The effort grows with the square.
  unsigned translation_edges = 3000;
  unsigned translation_axes = 9;  ///< Largest number of axes along which parts move.
};

struct RotationParameters {
  bool rotations = true;
  unsigned rotation_axes = 2;      ///< Largest number of axes of one part.
  unsigned rotation_stops = 24;    ///< Orientations per full turn at which the other parts are examined.
  unsigned rotation_halvings = 4;  ///< Bisections to find where a rotating part meets another.
  unsigned rotation_sweeps = 300;  ///< Largest number of pair sweeps for one group, until it changes.
  /// A surface is round if it has at least this number of facets per full turn. Smaller: more axes are found, also
  /// those of prisms.
  unsigned round_facets = 9;
  /// Smallest share of a part's surface that has to be round about an axis. If no more than this share is not round
  /// about it, the part is a body of revolution and is not rotated.
  double round_share = 0.02;
};

struct SimultaneousMotionParameters {
  bool simultaneous = true;
  unsigned simultaneous_parts = 3;  ///< Largest number of parts that move simultaneously.
  /// Largest number of sets that are moved, to depth 1, for one group until it changes.
  unsigned simultaneous_sets = 12;
  unsigned simultaneous_deep_sets = 2;  ///< Largest number of these sets that are moved deeper, if several parts moved.
  unsigned simultaneous_depth = 4;      ///< Depth to which these sets are moved.
  /// Largest cost of simultaneous motions, as a share of the cost of the searches for single parts so far. No limit
  /// once these searches are over.
  double simultaneous_share = 1;
};

/// path_search, pair_search and postponed_search.
struct PathSearchParameters {
  bool path_searches = true;
  bool pair_searches = true;
  bool postponed_searches = true;
  unsigned max_depth = 8;
  /// Largest depth if all arrangements that translations reach were visited and none of them frees a part.
  unsigned depth_without_translations = 4;
  /// Largest depth if no translations separate the group, which is proved: only a rotation may.
  unsigned depth_of_rotations = 1;
  /// Number of most touched parts that are considered: a search is repeated to the same depth when one of them has
  /// left.
  unsigned touched_parts = 3;
  /// Width of a cost class of searches, in powers of two. Within a class, parts that block more others come first.
  double cost_octaves = 0.5;
  /// While other pairs wait, the depth of the searches for a pair doubles up to this; then it is not limited.
  unsigned pair_depth = 64;
};

/// Parts that a snap fit holds.
struct SnapParameters {
  /// A part is held by a snap fit if a straight motion cuts in by no more than this share of the diagonal of the
  /// smaller part, and by less than half a wall. After `snap_failures` it is searched for to depth 1. Used only if
  /// parts may be forced (`run.force`). 0: no part.
  double snap_share = 0.1;
  unsigned snap_failures = 4;  ///< Parts whose deep searches found nothing, before there are no more.
  unsigned snap_depth = 2;     ///< Smallest depth of a search that counts as deep.
  /// Depth to which all parts of a group that are held so were searched for, before there are no more: there need not
  /// be `snap_failures` of them. Also the depth of the search for two parts with all others taken away.
  unsigned snap_depth_of_few = 3;
  unsigned snap_directions = 24;  ///< Largest number of directions that are measured for one part.
  std::int64_t snap_poses = 200;  ///< Poses measured for each pair of parts and direction.
  unsigned snap_group = 32;       ///< Largest group in which snap fits that hold each other are looked for.
};

}  // namespace blocking

struct BlockingParameters : blocking::StraightParameters,
                            blocking::FreeGroupParameters,
                            blocking::RepeatedPathParameters,
                            blocking::PartialTranslationParameters,
                            blocking::RotationParameters,
                            blocking::SimultaneousMotionParameters,
                            blocking::PathSearchParameters,
                            blocking::SnapParameters {
  PartOrder order = PartOrder::small_first;
  static void describe(Schema<BlockingParameters>& s);
};

}  // namespace dismantle
