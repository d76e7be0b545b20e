/// Parameters of the sdf_velocity simulator.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/sdf/field_parameters.h"

namespace dismantle::sdf_velocity {

struct Parameters {
  double drag = 40;
  double max_travel = 0.05;
  double depth = 2e-4;
  double contact_threshold = 0;
  double contact_spacing = 0.1;

  static void describe(Schema<Parameters>& s) {
    s.add("drag", &Parameters::drag,
          {.unit = "N s/unit", .min = 0, .min_open = true, .doc = "Drag: a free part moves at force / drag."});
    s.add("max_travel", &Parameters::max_travel,
          {.unit = "unit",
           .min = 1e-3,
           .max = 0.1,
           .doc = "Largest way of any point of a part in one step; contacts are seen as far ahead."});
    s.add("depth", &Parameters::depth,
          {.unit = "unit",
           .min = 1e-6,
           .max = 0.01,
           .doc = "What a step that turned out to enter a surface deeper than this did is put right in place."});
    s.add(
        "contact_threshold", &Parameters::contact_threshold,
        {.unit = "unit",
         .min = 0,
         .max = 0.1,
         .doc = "Depth at which contact begins to resist, on top of the pair's initial overlap: for fits that have to "
                "give. What it allows, the verifier has to allow too."});
    sdf::describe_points(s);
  }
};

}  // namespace dismantle::sdf_velocity
