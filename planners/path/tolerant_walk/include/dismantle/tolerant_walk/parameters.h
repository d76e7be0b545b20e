/// Parameters of trees of tolerated poses, and of the tolerant_rrt path planner.
#pragma once

#include "dismantle/parameters.h"

namespace dismantle::tolerant_walk {

/// Parameters of every planner that grows a PoseTree; the planner's own struct derives from this one.
struct TreeParameters {
  double tolerance_share = 0.8;
  double step = 0.006;
  /// Shortest first step of an extension, as a multiple of `step`. The length is drawn between this and
  /// `first_step_max`, uniformly in its logarithm.
  double first_step_min = 0.25;
  double first_step_max = 1;  ///< Longest first step of an extension, as a multiple of `step`.
  /// Ratio of each step of an extension to the step before, while poses are valid. Larger: free space is crossed with
  /// fewer state checks, but more of them are wasted at obstacles.
  double step_growth = 1.15;
  /// Longest step of an extension, as a multiple of `step`. Poses between two steps are not checked, so longer steps
  /// may pass through thin obstacles; the verifier refuses such paths.
  double longest_step = 10;
  /// Maximum number of steps of one extension. Larger: a part that moves freely gets further.
  std::int64_t extension_steps = 400;
  /// Edge of the cells of the distance fields, as a multiple of verify.max_penetration; samples are at least three
  /// cells apart. Smaller: fewer paths are refused; time and memory of the fields grow with the square.
  double field_cell = 1;
  /// Maximum number of samples of a part near another one; a fifth as many are on its whole surface. More: fewer paths
  /// are refused, each state check costs more.
  std::int64_t max_samples = 5'000;
  std::int64_t shortcuts = 60;  ///< Attempts to replace pieces of a path by direct motions. More: shorter paths.
  /// Distance between the state checks along a shortcut, as a multiple of verify.max_penetration. Larger: faster, but
  /// more paths are refused.
  double check_spacing = 2;
  /// Number of times that a refused path is shortened again with the refused place as a new sample. After that its
  /// branch is cut.
  std::int64_t repairs = 4;
  /// An earlier tree is resumed only if parts that have left caused at least this share of its invalid poses of its
  /// search. Smaller: trees are resumed more often, even in dead ends.
  double resume_share = 0.1;
  /// Poses that the rest of the path reproduces to within this distance are dropped (assembly units).
  double thinning = 1e-4;
  std::int64_t max_refusals = 12;  ///< Paths that the verifier may refuse before the search gives up.
};

/// Declares the parameters of a struct that derives from TreeParameters.
template <class P>
void describe_tree(Schema<P>& s) {
  s.add("tolerance_share", &TreeParameters::tolerance_share,
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc =
             "Share of verify.max_penetration by which a pose may penetrate deeper than the assembled pose does. Depth "
             "is measured at samples. Larger: the verifier refuses more paths. Smaller: tight fits stay closed."});
  s.add("step", &TreeParameters::step,
        {.unit = "unit",
         .min = 1e-5,
         .max = 1,
         .doc = "Scale of the steps of an extension: how far a point of the part moves in one step. Smaller: narrower "
                "passages are found, with more state checks."});
  s.advanced("field_cell", &TreeParameters::field_cell, {0.1, 100});
  s.advanced("max_samples", &TreeParameters::max_samples, {100, 1e7});
  s.advanced("first_step_min", &TreeParameters::first_step_min, {.min = 0, .max = 1, .min_open = true});
  s.advanced("first_step_max", &TreeParameters::first_step_max, {1, 100});
  s.advanced("step_growth", &TreeParameters::step_growth, {1, 10});
  s.advanced("longest_step", &TreeParameters::longest_step, {1, 1000});
  s.advanced("extension_steps", &TreeParameters::extension_steps, {1, 1e6});
  s.advanced("shortcuts", &TreeParameters::shortcuts, {0, 1e6});
  s.advanced("check_spacing", &TreeParameters::check_spacing, {0.01, 1000});
  s.advanced("thinning", &TreeParameters::thinning, {0, 0.01});
  s.advanced("max_refusals", &TreeParameters::max_refusals, {1, 1e6});
  s.advanced("repairs", &TreeParameters::repairs, {0, 1000});
  s.advanced("resume_share", &TreeParameters::resume_share, {0, 1});
}

struct Parameters : TreeParameters {
  /// Share of the extensions from poses that are furthest out in some direction. Smaller: the tree fills more of the
  /// space around the start.
  double outward = 0.6;
  std::int64_t state_checks = 25'000;
  double level_state_checks = 500;
  /// Share of the `outward` extensions that move on in that direction; the others are random.
  double outward_step = 0.7;
  double direct = 0.15;  ///< Share of the extensions in an outward direction that have no random component.
  /// Share of the extensions without `outward` that start from a node of the `newest`; the rest start from any node.
  double recent = 0.2;
  std::int64_t newest = 200;  ///< Number of nodes that count as new.

  static void describe(Schema<Parameters>& s) {
    describe_tree(s);
    s.advanced("outward", &Parameters::outward, {0, 1});
    s.advanced("outward_step", &Parameters::outward_step, {0, 1});
    s.advanced("direct", &Parameters::direct, {0, 1});
    s.advanced("recent", &Parameters::recent, {0, 1});
    s.advanced("newest", &Parameters::newest, {1, 1e9});
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
  }
};

}  // namespace dismantle::tolerant_walk
