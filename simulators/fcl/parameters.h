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
           .doc = "A state is reported with this depth, a proved upper bound, if copies of the parts shrunken by this "
                  "much do not collide; 0: always measure. README.md has the details."});
    s.add("resolution", &Parameters::resolution,
          {.unit = "unit", .min = 1e-6, .max = 0.1, .doc = "Accuracy of measured depths."});
    s.add("depth_limit", &Parameters::depth_limit,
          {.unit = "unit",
           .min = 1e-3,
           .doc = "States deeper than this are reported with an upper bound of their depth, half the smaller part's "
                  "diagonal: finding the deepest point costs time and changes no decision."});
  }
};

}  // namespace dismantle::mesh_collision
