/// Parameters of trees of tolerated poses, and of the tolerant_rrt path planner.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/path/shared_parameters.h"

namespace dismantle::tolerant_walk {

/// What every planner that grows a PoseTree has; its own struct derives from this one.
struct TreeParameters {
  double tolerance_share = 0.8;
  double step = 0.006;
  std::int64_t shortcuts = 60;
  double thinning = 1e-4;
  std::int64_t max_refusals = 12;
};

/// Declares `tolerance_share` and `step` for a struct that derives from TreeParameters.
template <class P>
void describe_poses(Schema<P>& s, const std::string& step_doc) {
  using path::inherited;
  s.add("tolerance_share", inherited<P>(&TreeParameters::tolerance_share),
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc = "Share of verify.max_penetration up to which poses may be deeper than when assembled. Less than all "
                "of it: depth is measured at samples."});
  s.add("step", inherited<P>(&TreeParameters::step), {.unit = "unit", .min = 1e-5, .max = 1, .doc = step_doc});
}

/// Declares the others.
template <class P>
void describe_paths(Schema<P>& s) {
  using path::inherited;
  s.add("shortcuts", inherited<P>(&TreeParameters::shortcuts),
        {.unit = "1", .min = 0, .max = 1e6, .doc = "Attempts to replace pieces of a path by straight ones."});
  path::add_thinning(s, inherited<P>(&TreeParameters::thinning));
  s.add("max_refusals", inherited<P>(&TreeParameters::max_refusals),
        {.unit = "1", .min = 1, .max = 1e6, .doc = "Paths that the verifier may refuse before it gives up."});
}

struct Parameters : TreeParameters {
  double outward = 0.6;
  std::int64_t state_checks = 25'000;
  double level_looks = 500;

  static void describe(Schema<Parameters>& s) {
    describe_poses(s,
                   "How far a point of the part moves in a first step, about; as long as nothing is in the way, steps "
                   "grow to ten times that.");
    s.add("outward", &Parameters::outward,
          {.unit = "1",
           .min = 0,
           .max = 1,
           .doc = "Share of the steps from poses that are furthest out in some direction."});
    s.add("state_checks", &Parameters::state_checks,
          {.unit = "1", .min = 1, .max = 1e12, .doc = "State checks before it gives up."});
    s.add(
        "level_state_checks", &Parameters::level_looks,
        {.unit = "1",
         .min = 0,
         .max = 1e12,
         .min_open = true,
         .doc = "The same for a search of depth 1 where the sequence planner limits depth; each further level doubles "
                "them, up to `state_checks`."});
    describe_paths(s);
  }
};

}  // namespace dismantle::tolerant_walk
