/// Geometry of the parts of an assembly, made once and shared through a PartMemo.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/part_memo.h"

namespace dismantle::geometry {

/// The closed shells of a part. Where it is thinner than a few tolerances, less penetration is allowed (see Solid).
DISMANTLE_API const std::vector<Solid>& solids_of(const Assembly& assembly, PartId part, PartMemo& memo,
                                                  double tolerance);
/// Corners of the convex hull of a part, in its assembled frame.
DISMANTLE_API const std::vector<Eigen::Vector3d>& hull_of(const Assembly& assembly, PartId part, PartMemo& memo);

}  // namespace dismantle::geometry
