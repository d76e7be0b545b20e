/// Parameters of the tolerant_rrt path planner, and of its tree.
#pragma once

#include "dismantle/parameters.h"

namespace dismantle::tolerant_walk {

struct Parameters {
  double tolerance_share = 0.8;
  double step = 0.006;
  double outward = 0.6;
  std::int64_t looks = 25'000;
  double level_looks = 500;
  std::int64_t shortcuts = 60;
  double thinning = 1e-4;
  std::int64_t max_refusals = 12;

  static void describe(Schema<Parameters>& s) {
    s.add("tolerance_share", &Parameters::tolerance_share,
          {.unit = "1",
           .min = 0,
           .max = 1,
           .doc = "Share of verify.max_penetration up to which poses may be deeper than when assembled. Less than all "
                  "of it: depth is measured at samples."});
    s.add("step", &Parameters::step,
          {.unit = "unit",
           .min = 1e-5,
           .max = 1,
           .doc = "How far a point of the part moves in a first step, about; as long as nothing is in the way, steps "
                  "grow to ten times that."});
    s.add("outward", &Parameters::outward,
          {.unit = "1",
           .min = 0,
           .max = 1,
           .doc = "Share of the steps from poses that are furthest out in some direction."});
    s.add("state_checks", &Parameters::looks,
          {.unit = "1", .min = 1, .max = 1e12, .doc = "State checks before it gives up."});
    s.add(
        "level_state_checks", &Parameters::level_looks,
        {.unit = "1",
         .min = 0,
         .max = 1e12,
         .min_open = true,
         .doc = "The same for a search of depth 1 where the sequence planner limits depth; each further level doubles "
                "them, up to `state_checks`."});
    s.add("shortcuts", &Parameters::shortcuts,
          {.unit = "1", .min = 0, .max = 1e6, .doc = "Attempts to replace pieces of a path by straight ones."});
    s.add("thinning", &Parameters::thinning,
          {.unit = "unit",
           .min = 0,
           .max = 0.01,
           .doc = "Poses that the rest of the path reproduces this closely are dropped."});
    s.add("max_refusals", &Parameters::max_refusals,
          {.unit = "1", .min = 1, .max = 1e6, .doc = "Paths that the verifier may refuse before it gives up."});
  }
};

}  // namespace dismantle::tolerant_walk
