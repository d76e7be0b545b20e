/// Parameters of the fcl simulator.
#pragma once

#include "dismantle/parameters.h"

namespace dismantle::mesh_collision {

struct Parameters {
  double certified_depth = 0.002;
  double resolution = 5e-4;
  double depth_limit = 0.005;

  static void describe(Schema<Parameters>& s) {
    s.add("certified_depth", &Parameters::certified_depth,
          {.unit = "unit",
           .min = 0,
           .max = 0.1,
           .doc = "States in which copies of the parts that are shrunken by this much stay clear are reported with "
                  "this depth, which is proved not to be exceeded; 0: measure always. README.md says how."});
    s.add("resolution", &Parameters::resolution,
          {.unit = "unit", .min = 1e-6, .max = 0.1, .doc = "Measured depths are exact to this much."});
    s.add("depth_limit", &Parameters::depth_limit,
          {.unit = "unit",
           .min = 1e-3,
           .doc = "States deeper than this are reported with an upper bound of their depth, half the smaller part's "
                  "diagonal: searching on for the deepest point costs time and changes no decision."});
  }
};

}  // namespace dismantle::mesh_collision
