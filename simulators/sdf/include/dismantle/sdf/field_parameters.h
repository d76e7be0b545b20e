/// Parameters common to all simulators on these fields, declared once.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/sdf/shape.h"

namespace dismantle::sdf {

/// Base of parameter structs.
struct ContactParameters {
  double contact_spacing = 0.1;
  /// Depth error of contact, as a share of verify.max_penetration: deeper states are corrected, and a contact nearer to
  /// a convex edge uses both faces. Smaller values are more accurate and slower.
  double contact_depth = 0.02;
  /// Depth that a pair may have beyond its initial overlap, as a share of verify.max_penetration. The overlap of the
  /// facets of round fits varies as they slide.
  double facet_share = 0.3;
};

/// For a P that derives from ContactParameters.
template <class P>
void describe_points(Schema<P>& s) {
  s.add("contact_spacing", &ContactParameters::contact_spacing,
        {.unit = "unit",
         .min = 1e-3,
         .max = 10,
         .doc = "Distance of contact points along edges. It adapts to the thinnest part by at most a factor of 2."});
  s.advanced("contact_depth", &ContactParameters::contact_depth, {1e-3, 0.5});
  s.advanced("facet_share", &ContactParameters::facet_share, {0, 1});
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
