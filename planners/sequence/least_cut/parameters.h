/// Parameters of `least_cut`.
#pragma once

#include "dismantle/parameters.h"

namespace dismantle {

struct LeastCutParameters {
  unsigned directions = 26;
  unsigned candidates = 24;
  double quick_margin = 2;       ///< time kept for each remaining part, as a multiple of the slowest quick step so far
  double overtime = 0.5;         ///< seconds beyond run.timeout in which the remaining parts get quick steps
  unsigned part_axes = 6;        ///< face axes used per part, largest area first
  unsigned group_axes = 16;      ///< face axes of a group; the coordinate axes are added
  unsigned quick_axes = 4;       ///< as group_axes, for the first estimate under a time limit
  unsigned rays = 24;            ///< rays from the vertices of each part that measure what blocks a translation
  double blocking_share = 0.02;  ///< a part moves along if more than this share of the rays hits it
  double firm_share = 0.3;       ///< the same, for a second, smaller set of parts
  double clearance = 2;          ///< distance of the hulls at the end, in tolerances
  double max_turns = 100;        ///< of a threaded part in one step; 0: translations only
  unsigned set_candidates = 4;   ///< motions that each set of parts may have among the candidates
  double set_similarity = 0.9;   ///< cosine above which two directions of one set count as one
  unsigned depth_samples = 48;   ///< vertices of each part at which a depth is estimated before it is measured
  unsigned finalists = 4;        ///< candidates that are measured again, to a tolerance
  double depth_resolution = 8;   ///< of the depths that are compared, in tolerances
  double depth_share = 0.1;      ///< the same as a share of the depth; the larger of the two applies
  std::int64_t depth_poses = 200;  ///< poses measured per pair of parts for that comparison
  unsigned outlook_depths = 400;   ///< motions that are compared to estimate what is left to force after a step
  static void describe(Schema<LeastCutParameters>& schema);
};

}  // namespace dismantle
