/// Materials of the parts in glTF files.
#pragma once

#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "glb/glb_file.h"

namespace dismantle {

struct GlbPaint {
  GlbJson material;
  GlbJson order_colour;  ///< linear RGBA by the order of removal where `material` has the part's own colour; else null
};

/// One per part of the assembly: in its own colour where the files tell parts apart by colours, else by the order of
/// removal, from red to violet; what stays is grey; what is forced out glows red. Parts of one colour of their own have equal materials.
std::vector<GlbPaint> paint_parts(const Plan& plan, const Assembly& assembly);

}  // namespace dismantle
