/// The exploded view.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// By place in PlanAssembly::parts: how far to move each part from where it is when assembled, input units. Each goes
/// in the direction in which the plan takes it out, groups as a whole first, so far that its box is clear of those of
/// what it was taken from.
/// @throws InputError when the plan names a part that the assembly does not have.
DISMANTLE_API std::vector<Eigen::Vector3d> exploded_offsets(const Plan& plan, const Assembly& assembly);

}  // namespace dismantle
