/// Parameters that all simulators on these fields have; declared once.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/sdf/shape.h"

namespace dismantle::sdf {

/// Members that parameter structs derive from.
struct ContactParameters {
  double contact_spacing = 0.1;
  double contact_depth = 0.02;
  double facet_share = 0.3;
};

/// For a P that derives from ContactParameters.
template <class P>
void describe_points(Schema<P>& s) {
  s.add("contact_spacing", static_cast<double P::*>(&ContactParameters::contact_spacing),
        {.unit = "unit",
         .min = 1e-3,
         .max = 10,
         .doc = "Distance of contact points along edges; halved or doubled at most, after the thinnest part."});
  s.add("contact_depth", static_cast<double P::*>(&ContactParameters::contact_depth),
        {.unit = "max_penetration",
         .min = 1e-3,
         .max = 0.5,
         .doc = "Advanced. Depth by which contact may be off, as a share of verify.max_penetration: deeper states are "
                "corrected, and a contact that is nearer to a convex edge is held by both faces. Smaller: more "
                "accurate, slower."});
  s.add("facet_share", static_cast<double P::*>(&ContactParameters::facet_share),
        {.unit = "max_penetration",
         .min = 0,
         .max = 1,
         .doc = "Advanced. Depth that a pair may overlap beyond its initial overlap, as a share of "
                "verify.max_penetration. Facets of round fits overlap more or less as they slide."});
}

template <class P>
ShapeOptions shape_options(const P& p) {
  ShapeOptions options;
  options.points.spacing = p.contact_spacing;
  options.contact_depth = p.contact_depth;
  options.facet_share = p.facet_share;
  return options;
}

}  // namespace dismantle::sdf
