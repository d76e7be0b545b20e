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

  static void describe(Schema<Parameters>& s) {
    s.add("straight_first", &Parameters::straight_first,
          {.doc = "Try to lift the part, turn it, carry it over everything and put it down before any tree is grown."});
    s.add("clearance", &Parameters::clearance,
          {.unit = "unit", .min = 0, .doc = "What a part that is carried over others keeps off them."});
    s.add("range", &Parameters::range,
          {.unit = "unit", .min = 0, .min_open = true, .doc = "Longest extension of a tree."});
    s.add("step", &Parameters::step,
          {.unit = "unit",
           .min = 1e-5,
           .max = 1,
           .doc = "Extensions are checked every so far; largest way of any point of the part."});
    s.add("tolerance_share", &Parameters::tolerance_share,
          {.unit = "1",
           .min = 0,
           .max = 1,
           .doc = "Share of verify.max_penetration, above the initial overlap, at which a state counts as colliding."});
    s.add("simplify", &Parameters::simplify, {.doc = "Replace detours by straight motions where these are free."});
    s.add("max_checks", &Parameters::max_checks,
          {.unit = "1", .min = 0, .doc = "State checks for one transfer; 0 = no limit but those of the run."});
  }
};

}  // namespace dismantle::rrt_connect
