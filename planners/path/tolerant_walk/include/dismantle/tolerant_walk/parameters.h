/// Parameters of trees of tolerated poses, and of the tolerant_rrt path planner.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/path/shared_parameters.h"

namespace dismantle::tolerant_walk {

/// Parameters of every planner that grows a PoseTree; the planner's own struct derives from this one.
struct TreeParameters {
  double tolerance_share = 0.8;
  double step = 0.006;
  double first_step_min = 0.25;
  double first_step_max = 1;
  double step_growth = 1.15;
  double longest_step = 10;
  std::int64_t extension_steps = 400;
  double field_cell = 1;
  std::int64_t max_samples = 5'000;
  double overlap_reach = 3;
  std::int64_t shortcuts = 60;
  double check_spacing = 2;
  std::int64_t repairs = 4;
  double resume_share = 0.1;
  double thinning = 1e-4;
  std::int64_t max_refusals = 12;
};

/// Declares which poses are valid, and the scale of steps.
template <class P>
void describe_poses(Schema<P>& s) {
  using path::inherited;
  s.add("tolerance_share", inherited<P>(&TreeParameters::tolerance_share),
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc =
             "Share of verify.max_penetration by which a pose may penetrate deeper than the assembled pose does. Depth "
             "is measured at samples. Larger: the verifier refuses more paths. Smaller: tight fits stay closed."});
  s.add("step", inherited<P>(&TreeParameters::step),
        {.unit = "unit",
         .min = 1e-5,
         .max = 1,
         .doc = "Scale of the steps of an extension: how far a point of the part moves in one step. Smaller: narrower "
                "passages are found, with more state checks."});
}

/// Declares how poses are checked.
template <class P>
void describe_samples(Schema<P>& s) {
  using path::inherited;
  s.add("field_cell", inherited<P>(&TreeParameters::field_cell),
        {.unit = "max_penetration",
         .min = 0.1,
         .max = 100,
         .doc =
             "Advanced. Edge of the cells of the distance fields, as a multiple of verify.max_penetration; samples are "
             "at least three cells apart. Smaller: fewer paths are refused; time and memory of the fields grow with "
             "the square."});
  s.add("max_samples", inherited<P>(&TreeParameters::max_samples),
        {.unit = "1",
         .min = 100,
         .max = 1e7,
         .doc = "Advanced. Maximum number of samples of a part near another one; a fifth as many are on its whole "
                "surface. More: fewer paths are refused, each state check costs more."});
  s.add("overlap_reach", inherited<P>(&TreeParameters::overlap_reach),
        {.unit = "overlap",
         .min = 0,
         .max = 1000,
         .doc =
             "Advanced. For a group thinner than its initial overlap: distance from the start up to which that overlap "
             "is allowed, as a multiple of the overlap, plus two cells."});
}

/// Declares how the steps of an extension vary.
template <class P>
void describe_extensions(Schema<P>& s) {
  using path::inherited;
  s.add("first_step_min", inherited<P>(&TreeParameters::first_step_min),
        {.unit = "step",
         .min = 0,
         .max = 1,
         .min_open = true,
         .doc = "Advanced. Shortest first step of an extension, as a multiple of `step`. The length is drawn between "
                "this and `first_step_max`, uniformly in its logarithm."});
  s.add("first_step_max", inherited<P>(&TreeParameters::first_step_max),
        {.unit = "step",
         .min = 1,
         .max = 100,
         .doc = "Advanced. Longest first step of an extension, as a multiple of `step`."});
  s.add("step_growth", inherited<P>(&TreeParameters::step_growth),
        {.unit = "1",
         .min = 1,
         .max = 10,
         .doc = "Advanced. Ratio of each step of an extension to the step before, while poses are valid. Larger: free "
                "space is crossed with fewer state checks, but more of them are wasted at obstacles."});
  s.add("longest_step", inherited<P>(&TreeParameters::longest_step),
        {.unit = "step",
         .min = 1,
         .max = 1000,
         .doc = "Advanced. Longest step of an extension, as a multiple of `step`. Poses between two steps are not "
                "checked, so longer steps may pass through thin obstacles; the verifier refuses such paths."});
  s.add("extension_steps", inherited<P>(&TreeParameters::extension_steps),
        {.unit = "1",
         .min = 1,
         .max = 1e6,
         .doc = "Advanced. Maximum number of steps of one extension. Larger: a part that moves freely gets further."});
}

/// Declares how paths are shortened and repaired, and when a search resumes or gives up.
template <class P>
void describe_paths(Schema<P>& s) {
  using path::inherited;
  s.add("shortcuts", inherited<P>(&TreeParameters::shortcuts),
        {.unit = "1",
         .min = 0,
         .max = 1e6,
         .doc = "Attempts to replace pieces of a path by direct motions. More: shorter paths."});
  s.add(
      "check_spacing", inherited<P>(&TreeParameters::check_spacing),
      {.unit = "max_penetration",
       .min = 0.01,
       .max = 1000,
       .doc = "Advanced. Distance between the state checks along a shortcut, as a multiple of verify.max_penetration. "
              "Larger: faster, but more paths are refused."});
  path::add_thinning(s, inherited<P>(&TreeParameters::thinning));
  s.add("max_refusals", inherited<P>(&TreeParameters::max_refusals),
        {.unit = "1", .min = 1, .max = 1e6, .doc = "Paths that the verifier may refuse before the search gives up."});
  s.add("repairs", inherited<P>(&TreeParameters::repairs),
        {.unit = "1",
         .min = 0,
         .max = 1000,
         .doc =
             "Advanced. Number of times that a refused path is shortened again with the refused place as a new sample. "
             "After that its branch is cut."});
  s.add("resume_share", inherited<P>(&TreeParameters::resume_share),
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc = "Advanced. An earlier tree is resumed only if parts that have left caused at least this share of its "
                "invalid poses since its last progress. Smaller: trees are resumed more often, even in dead ends."});
}

struct Parameters : TreeParameters {
  double outward = 0.6;
  std::int64_t state_checks = 25'000;
  double level_state_checks = 500;
  double outward_step = 0.7;
  double direct = 0.15;
  double recent = 0.2;
  std::int64_t newest = 200;

  static void describe(Schema<Parameters>& s) {
    describe_poses(s);
    s.add("outward", &Parameters::outward,
          {.unit = "1",
           .min = 0,
           .max = 1,
           .doc = "Share of the extensions from poses that are furthest out in some direction. Smaller: the tree fills "
                  "more of the space around the start."});
    s.add(
        "outward_step", &Parameters::outward_step,
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc = "Advanced. Share of the `outward` extensions that move on in that direction; the others are random."});
    s.add("direct", &Parameters::direct,
          {.unit = "1",
           .min = 0,
           .max = 1,
           .doc = "Advanced. Share of the extensions in an outward direction that have no random component."});
    s.add(
        "recent", &Parameters::recent,
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc = "Advanced. Share of the extensions without `outward` that start from a node of the `newest`; the rest "
                "start from any node."});
    s.add("newest", &Parameters::newest,
          {.unit = "1", .min = 1, .max = 1e9, .doc = "Advanced. Number of nodes that count as new."});
    s.add("state_checks", &Parameters::state_checks,
          {.unit = "1", .min = 1, .max = 1e12, .doc = "State checks before the search gives up."});
    s.add(
        "level_state_checks", &Parameters::level_state_checks,
        {.unit = "1",
         .min = 0,
         .max = 1e12,
         .min_open = true,
         .doc =
             "Limit of state checks for depth 1 when the sequence planner limits the depth. Each further level doubles "
             "the limit, up to `state_checks`."});
    describe_extensions(s);
    describe_samples(s);
    describe_paths(s);
  }
};

}  // namespace dismantle::tolerant_walk
