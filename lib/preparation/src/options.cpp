#include "dismantle/preparation/prepare.h"

namespace dismantle {

void PrepareOptions::describe(Schema<PrepareOptions>& s) {
  s.add("weld", &PrepareOptions::weld,
        {.unit = "1",
         .min = 0.0,
         .max = 0.01,
         .doc = "Vertices on open edges closer than this are merged, relative to the diagonal of the part's box; equal "
                "positions always are. Closed surfaces are never changed. (Appendix B.1, step 2.)"});
  s.add("repair", &PrepareOptions::repair,
        {.unit = "1",
         .doc = "Close T-junctions and small flat holes and drop inner walls of parts that are not watertight. What is "
                "left open then is a case for `open`. The paper does not repair (step 2)."});
  s.add("max_hole", &PrepareOptions::max_hole,
        {.unit = "1",
         .min = 0.0,
         .max = 1.0,
         .doc = "Largest hole that repair closes, as a share of the part's surface area."});
  s.add_choice<OpenSurfaces>(
      "open", &PrepareOptions::open,
      {{"wall", OpenSurfaces::wall, "they are planned: their surface is a wall that no part may pass through"},
       {"exclude", OpenSurfaces::exclude, "they are left out (the paper, step 2)"}},
      "What becomes of parts whose surface is not closed after repair.");
  s.add("drop_duplicates", &PrepareOptions::drop_duplicates,
        {.unit = "1", .doc = "Drop a part that has the geometry and the place of an earlier one (step 3)."});
  s.add("max_overlap", &PrepareOptions::max_overlap,
        {.unit = "1",
         .min = 0.0,
         .max = 1.0,
         .doc = "Drop parts that lie inside others with more than this share of their volume, the worst first (step 4; "
                "the paper: 0.1). 1 = keep all."});
  s.add("min_thickness", &PrepareOptions::min_thickness,
        {.unit = "1",
         .min = 0.0,
         .max = 1.0,
         .max_open = true,
         .doc = "Drop parts whose oriented box is thinner than this share of the longest edge of the assembly's box "
                "(step 5; the paper: 0.01). 0 = keep all."});
  s.add(
      "largest_connected", &PrepareOptions::largest_connected,
      {.unit = "1",
       .doc = "Keep only the largest set of parts whose convex hulls meet (step 6). Off: floating parts are named in a "
              "warning."});
  s.add("normalize", &PrepareOptions::normalize,
        {.unit = "1",
         .doc = "Scale and centre the assembly (step 7). Off: assembly units are input units, and all tolerances are "
                "in input units."});
  s.add("size", &PrepareOptions::size,
        {.unit = "unit",
         .min = 0.01,
         .max = 10000,
         .doc = "Longest edge of the assembly's box after scaling (step 7). Other defaults assume 10."});
  s.add("subdivide", &PrepareOptions::subdivide,
        {.unit = "unit",
         .min = 0.0,
         .doc = "Longest edge of the surface that contact points are taken from (step 9). 0 = unchanged."});
  s.add_choice<FlexibleParts>("flexible", &PrepareOptions::flexible,
                              {{"recognised", FlexibleParts::recognised,
                                "also parts whose shape is that of a spring, an O-ring or a round belt, and that "
                                "overlap others when assembled"},
                               {"declared", FlexibleParts::declared,
                                "those that constraints.flexible names, and those that the file says are of a material "
                                "that bends"}},
                              "Which parts count as flexible: other parts that are in them when assembled may cut into "
                              "them as deep as they are "
                              "thick.");
  s.add(
      "unit", &PrepareOptions::unit,
      {.doc =
           "Unit of length of an input that names none: mm, cm, m, inch... Sizes of fasteners, weights and what people "
           "read depend on it. Empty: not known; sizes are then looked up as if in mm."});
  s.add("max_triangles", &PrepareOptions::max_triangles,
        {.unit = "1",
         .min = 1.0,
         .doc = "Refuse assemblies with more triangles than this, and subdivisions that would make more."});
}

}  // namespace dismantle
