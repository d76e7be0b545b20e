#include "dismantle/engine/force_options.h"

namespace dismantle {

void ForceOptions::describe(Schema<ForceOptions>& s) {
  s.add("share", &ForceOptions::share,
        {.unit = "1",
         .min = 0,
         .max = 0.9,
         .min_open = true,
         .doc = "Advanced. Share of run.timeout that is reserved for forced steps and for verified steps between them. "
                "Each remaining part gets its step in this time; with more time the steps cut in less."});
  s.add("verified_share", &ForceOptions::verified_share,
        {.unit = "1",
         .min = 0,
         .max = 0.9,
         .doc = "Advanced. Minimum share of the remaining time for verified steps after a forced one."});
  s.add(
      "quick_margin", &ForceOptions::quick_margin,
      {.unit = "1",
       .min = 1,
       .max = 100,
       .doc =
           "Advanced. Time that is reserved for each remaining part, as a multiple of the slowest quick step so far."});
  s.add("overtime", &ForceOptions::overtime,
        {.unit = "s",
         .min = 0,
         .max = 3600,
         .doc = "Advanced. Time beyond run.timeout in which the remaining parts get quick forced steps. Parts that "
                "need longer stay."});
  s.add("directions", &ForceOptions::directions,
        {.unit = "1",
         .min = 0,
         .max = 1000,
         .doc = "Advanced. Number of directions, spread over a sphere, that a forced step may take in addition to the "
                "axes of the parts' faces."});
  s.add("part_axes", &ForceOptions::part_axes,
        {.unit = "1",
         .min = 1,
         .max = 1000,
         .doc = "Advanced. Number of face axes that are used per part, largest area first."});
  s.add("group_axes", &ForceOptions::group_axes,
        {.unit = "1",
         .min = 1,
         .max = 1000,
         .doc = "Advanced. Number of face axes of a group along which motions are compared, largest area first; the "
                "coordinate axes are added."});
  s.add("quick_axes", &ForceOptions::quick_axes,
        {.unit = "1",
         .min = 1,
         .max = 1000,
         .doc = "Advanced. As group_axes, for the first estimate under a time limit."});
  s.add("rays", &ForceOptions::rays,
        {.unit = "1",
         .min = 1,
         .max = 100000,
         .doc = "Advanced. Number of rays from the vertices of each part that measure what blocks a translation."});
  s.add("blocking_share", &ForceOptions::blocking_share,
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc = "Advanced. A blocking part moves along if more than this share of the rays hits it; a smaller overlap "
                "can be cut through."});
  s.add("firm_share", &ForceOptions::firm_share,
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc = "Advanced. As blocking_share, for a second, smaller set of parts that move along."});
  s.add(
      "clearance", &ForceOptions::clearance,
      {.unit = "tolerances",
       .min = 1,
       .max = 1000,
       .doc = "Advanced. Distance between the convex hulls of both sides at the end of a forced step, in multiples of "
              "verify.max_penetration."});
  s.add("max_turns", &ForceOptions::max_turns,
        {.unit = "1",
         .min = 0,
         .max = 10000,
         .doc = "Advanced. Maximum number of turns of a threaded part in one forced step; 0 = translations only."});
  s.add("candidates", &ForceOptions::candidates,
        {.unit = "1",
         .min = 1,
         .max = 100000,
         .doc =
             "Advanced. Maximum number of motions whose depth is measured for one forced step, most promising first."});
  s.add("set_candidates", &ForceOptions::set_candidates,
        {.unit = "1",
         .min = 1,
         .max = 100000,
         .doc = "Advanced. Number of these motions that each set of parts may have, even if there are many sets."});
  s.add(
      "set_similarity", &ForceOptions::set_similarity,
      {.unit = "1",
       .min = -1,
       .max = 1,
       .doc = "Advanced. Cosine of the angle between two directions of the same set of parts above which only the more "
              "promising one is measured."});
  s.add("depth_samples", &ForceOptions::depth_samples,
        {.unit = "1",
         .min = 1,
         .max = 100000,
         .doc = "Advanced. Number of vertices of each part at which the depth of a motion is estimated before it is "
                "measured."});
  s.add("coarse_resolution", &ForceOptions::coarse_resolution,
        {.unit = "tolerances",
         .min = 1,
         .max = 1000,
         .doc = "Advanced. Resolution of the depth by which candidates are compared, in multiples of "
                "verify.max_penetration."});
  s.add("coarse_share", &ForceOptions::coarse_share,
        {.unit = "1",
         .min = 0.001,
         .max = 1,
         .doc = "Advanced. As coarse_resolution, but as a share of the depth; the larger of the two applies."});
  s.add("coarse_poses", &ForceOptions::coarse_poses,
        {.unit = "1",
         .min = 1,
         .max = 1e9,
         .doc = "Advanced. Maximum number of poses measured per pair of parts for that comparison."});
  s.add("finalists", &ForceOptions::finalists,
        {.unit = "1",
         .min = 1,
         .max = 100000,
         .doc = "Advanced. Maximum number of candidates that are measured again with a resolution of one tolerance."});
  s.add("fine_share", &ForceOptions::fine_share,
        {.unit = "1",
         .min = 0.001,
         .max = 1,
         .doc = "Advanced. Resolution of the depth that the plan states, as a share of it; at least one tolerance."});
  s.add("fine_poses", &ForceOptions::fine_poses,
        {.unit = "1",
         .min = 1,
         .max = 1e9,
         .doc = "Advanced. Maximum number of poses measured per pair of parts of a finalist."});
  s.add("retry_depth", &ForceOptions::retry_depth,
        {.unit = "1",
         .min = 1,
         .max = 1000,
         .doc = "Advanced. Depth of the searches for verified paths of the parts that are left after a forced step."});
}

}  // namespace dismantle
