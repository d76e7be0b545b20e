/// The exploded view.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// In the order of PlanAssembly::parts: displacement of each part from its assembled position, input units. Each moves
/// in the direction of its removal, groups first as a whole, until its box is clear of the boxes of the group that it
/// left.
/// @throws InputError when the plan names a part that the assembly does not have.
DISMANTLE_API std::vector<Eigen::Vector3d> exploded_offsets(const Plan& plan, const Assembly& assembly);

}  // namespace dismantle
