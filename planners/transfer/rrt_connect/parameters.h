/// Parameters of the transfer planner.
#pragma once

#include <cstdint>

#include "dismantle/parameters.h"

namespace dismantle::rrt_connect {

struct Parameters {
  bool straight_first = true;
  double clearance = 0.1;
  double range = 2;
  double step = 0.05;
  double tolerance_share = 0.4;
  bool simplify = true;
  std::int64_t max_checks = 30'000;
  int max_refused = 10;

  static void describe(Schema<Parameters>& s) {
    s.add("straight_first", &Parameters::straight_first,
          {.doc =
               "Before any tree is grown, try to lift the part, rotate it, carry it over everything and put it down."});
    s.add("clearance", &Parameters::clearance,
          {.unit = "unit", .min = 0, .doc = "Height above all other parts at which a part is carried over them."});
    s.add("range", &Parameters::range,
          {.unit = "unit", .min = 0, .min_open = true, .doc = "Longest extension of a tree."});
    s.add("step", &Parameters::step,
          {.unit = "unit",
           .min = 1e-5,
           .max = 1,
           .doc = "Distance between checked states of an extension: the largest displacement of any point of the part. "
                  "Smaller steps miss fewer thin obstacles and take more checks."});
    s.add("tolerance_share", &Parameters::tolerance_share,
          {.unit = "1",
           .min = 0,
           .max = 1,
           .doc = "Share of verify.max_penetration, above the initial overlap, at which a state counts as colliding."});
    s.add("simplify", &Parameters::simplify, {.doc = "Replace detours by straight motions where these are free."});
    s.add("max_checks", &Parameters::max_checks,
          {.unit = "1",
           .min = 0,
           .doc = "Largest number of state checks for one transfer; 0 = only the limits of the run apply."});
    s.add("max_refused", &Parameters::max_refused,
          {.unit = "1",
           .min = 1,
           .max = 1e6,
           .doc = "Number of refused paths after which the search ends. Where simulator and verifier disagree, more "
                  "paths of the same kind rarely help."});
  }
};

}  // namespace dismantle::rrt_connect
