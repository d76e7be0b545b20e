/// Parameters that all simulators on these fields have; declared once.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/sdf/shape.h"

namespace dismantle::sdf {

/// `P` has a member `double contact_spacing`.
template <class P>
void describe_points(Schema<P>& s) {
  s.add("contact_spacing", &P::contact_spacing,
        {.unit = "unit",
         .min = 1e-3,
         .max = 10,
         .doc = "Distance of contact points along edges; halved or doubled at most, after the thinnest part."});
}

template <class P>
ShapeOptions shape_options(const P& p) {
  ShapeOptions options;
  options.points.spacing = p.contact_spacing;
  return options;
}

}  // namespace dismantle::sdf
