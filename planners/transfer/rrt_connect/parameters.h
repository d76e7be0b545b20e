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
  /// Share of verify.max_penetration, above the initial overlap, at which a state counts as colliding.
  double tolerance_share = 0.4;
  bool simplify = true;
  std::int64_t max_checks = 30'000;
  /// Number of refused paths after which the search ends. Where simulator and verifier disagree, more paths of the same
  /// kind rarely help.
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
    s.advanced("tolerance_share", &Parameters::tolerance_share, {0, 1});
    s.add("simplify", &Parameters::simplify, {.doc = "Replace detours by straight motions where these are free."});
    s.add("max_checks", &Parameters::max_checks,
          {.unit = "1",
           .min = 0,
           .doc = "Largest number of state checks for one transfer; 0 = only the limits of the run apply."});
    s.advanced("max_refused", &Parameters::max_refused, {1, 1e6});
  }
};

}  // namespace dismantle::rrt_connect
