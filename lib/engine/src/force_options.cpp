#include "dismantle/engine/force_options.h"

namespace dismantle {

void ForceOptions::describe(Schema<ForceOptions>& s) {
  s.add("share", &ForceOptions::share,
        {.unit = "1",
         .min = 0,
         .max = 0.9,
         .min_open = true,
         .doc = "Advanced. Share of run.timeout that is kept for forced steps and for verified ones between them. Each "
                "part that is left gets its step in it; with more time the steps cut in less."});
  s.add("verified_share", &ForceOptions::verified_share,
        {.unit = "1",
         .min = 0,
         .max = 0.9,
         .doc = "Advanced. Share of the time that is left, at least, for verified steps after a forced one."});
  s.add("quick_margin", &ForceOptions::quick_margin,
        {.unit = "1",
         .min = 1,
         .max = 100,
         .doc = "Advanced. Time that is kept for each part that is left, as a multiple of what the slowest quick step "
                "has taken so far."});
  s.add(
      "overtime", &ForceOptions::overtime,
      {.unit = "s",
       .min = 0,
       .max = 3600,
       .doc = "Advanced. Time beyond run.timeout in which the remaining parts get quick forced steps. Parts for which "
              "that is not enough stay."});
  s.add("directions", &ForceOptions::directions,
        {.unit = "1",
         .min = 0,
         .max = 1000,
         .doc = "Advanced. Directions of a sphere that a forced step may take, beside the axes of the parts' faces."});
  s.add("part_axes", &ForceOptions::part_axes,
        {.unit = "1",
         .min = 1,
         .max = 1000,
         .doc = "Advanced. Axes of one part's faces that are used, largest area first."});
  s.add("group_axes", &ForceOptions::group_axes,
        {.unit = "1",
         .min = 1,
         .max = 1000,
         .doc = "Advanced. Axes of the faces of all parts of a group along which motions are compared, largest area "
                "first; the coordinate axes come on top."});
  s.add("quick_axes", &ForceOptions::quick_axes,
        {.unit = "1",
         .min = 1,
         .max = 1000,
         .doc = "Advanced. As group_axes, for the first estimate under a time limit."});
  s.add("rays", &ForceOptions::rays,
        {.unit = "1",
         .min = 1,
         .max = 100000,
         .doc = "Advanced. Rays from the vertices of each part that measure what is in the way of a translation."});
  s.add(
      "blocking_share", &ForceOptions::blocking_share,
      {.unit = "1",
       .min = 0,
       .max = 1,
       .doc = "Advanced. A part moves along with what it blocks when more than this share of the rays hit it; less is "
              "a small overlap that can be cut through."});
  s.add("firm_share", &ForceOptions::firm_share,
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc = "Advanced. The same for a second, smaller set of parts that move along."});
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
         .doc = "Advanced. Turns of a threaded part in one forced step, at most; 0 = translations only."});
  s.add("candidates", &ForceOptions::candidates,
        {.unit = "1",
         .min = 1,
         .max = 100000,
         .doc = "Advanced. Motions whose depth is measured for one forced step, the most promising ones."});
  s.add(
      "set_candidates", &ForceOptions::set_candidates,
      {.unit = "1",
       .min = 1,
       .max = 100000,
       .doc = "Advanced. Of them, motions of the same set of parts that are measured even where there are many sets."});
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
         .doc = "Advanced. Vertices of each part at which the depth of a motion is estimated before it is measured."});
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
         .doc = "Advanced. The same as a share of the depth; the larger of the two counts."});
  s.add("coarse_poses", &ForceOptions::coarse_poses,
        {.unit = "1", .min = 1, .max = 1e9, .doc = "Advanced. Poses measured per pair of parts for that comparison."});
  s.add("finalists", &ForceOptions::finalists,
        {.unit = "1",
         .min = 1,
         .max = 100000,
         .doc = "Advanced. Candidates that are measured again with the resolution of one tolerance."});
  s.add("fine_share", &ForceOptions::fine_share,
        {.unit = "1",
         .min = 0.001,
         .max = 1,
         .doc = "Advanced. Resolution of the depth that the plan states, as a share of it; at least one tolerance."});
  s.add("fine_poses", &ForceOptions::fine_poses,
        {.unit = "1", .min = 1, .max = 1e9, .doc = "Advanced. Poses measured per pair of parts of a finalist."});
  s.add("retry_depth", &ForceOptions::retry_depth,
        {.unit = "1",
         .min = 1,
         .max = 1000,
         .doc = "Advanced. Depth of the searches for verified paths of the parts that are left after a forced step."});
}

}  // namespace dismantle
