/// Parameters that all simulators on these fields have; declared once.
#pragma once

#include <string>

#include "dismantle/parameters.h"
#include "dismantle/sdf/shape.h"

namespace dismantle::sdf {

/// `P` has members `double cell`, `std::int64_t cells_per_edge` and `double contact_spacing`.
template <class P>
void describe_fields(Schema<P>& s) {
  s.add("cell", &P::cell,
        {.unit = "unit", .min = 1e-3, .max = 1, .doc = "Largest cell of the distance field (appendix A)."});
  s.add("cells_per_edge", &P::cells_per_edge,
        {.unit = "1",
         .min = 1,
         .max = 1000,
         .doc = "At least so many cells along each edge of the part's box (appendix A)."});
  s.add("contact_spacing", &P::contact_spacing,
        {.unit = "unit",
         .min = 1e-3,
         .max = 10,
         .doc = "Distance of contact points along edges; halved or doubled at most, after the thinnest part."});
}

template <class P>
ShapeOptions shape_options(const P& p) {
  ShapeOptions options;
  options.grid.cell = p.cell;
  options.grid.cells_per_edge = static_cast<int>(p.cells_per_edge);
  options.points.spacing = p.contact_spacing;
  return options;
}

}  // namespace dismantle::sdf
