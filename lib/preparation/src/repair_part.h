/// Step 2 for one part: from the triangles of a file to a closed, outward surface, or the reason why not.
#pragma once

#include "dismantle/mesh.h"
#include "dismantle/preparation/prepare.h"

namespace dismantle {

/// Changes `mesh` in place (input units) and fills `report` but for name and file. report.kept says whether it is
/// usable.
void repair_part(Mesh& mesh, const std::string& unit, const PrepareOptions& options, PartReport& report,
                 const RunContext& context);

}  // namespace dismantle
