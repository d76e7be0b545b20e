/// Parameters of the sdf_velocity simulator.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/sdf/field_parameters.h"

namespace dismantle::sdf_velocity {

struct Parameters : sdf::ContactParameters {
  double drag = 40;
  double max_travel = 0.05;
  double contact_threshold = 0;
  /// Largest motion of a point in one step beyond the distance known to be free, as a multiple of
  /// verify.max_penetration. To block parts, a wall must be thicker than twice this.
  double blind_travel = 2;
  double stall_share = 0.02;  ///< A part that moves by less than this share of the free way has stalled.

  static void describe(Schema<Parameters>& s) {
    s.add("drag", &Parameters::drag,
          {.unit = "N s/unit", .min = 0, .min_open = true, .doc = "Drag: a free part moves at force / drag."});
    s.add("max_travel", &Parameters::max_travel,
          {.unit = "unit",
           .min = 1e-3,
           .max = 0.1,
           .doc = "Largest motion of any point of a part in one step; contacts are detected up to this distance."});
    s.add("contact_threshold", &Parameters::contact_threshold,
          {.unit = "unit",
           .min = 0,
           .max = 0.1,
           .doc = "Depth at which contact begins to resist, on top of the pair's initial overlap: for fits that must "
                  "yield. The verifier must allow the same depth."});
    s.advanced("blind_travel", &Parameters::blind_travel, {0.1, 100});
    s.advanced("stall_share", &Parameters::stall_share, {0, 0.5});
    sdf::describe_points(s);
  }
};

}  // namespace dismantle::sdf_velocity
