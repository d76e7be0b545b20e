/// Another plan of the same assembly: the one that is built around its largest part.
#pragma once

#include <vector>

#include "best_order/segment.h"

namespace dismantle::order {

/// A plan whose steps separate the same parts, and in which the part with the largest box stays: where `plan` takes it
/// out of a group, along a straight line, the others leave it in the opposite direction, in the smallest groups that
/// can move by themselves (Wilson and Latombe 1994). These come apart outside, by the steps of `plan`: they are
/// sub-assemblies. Empty: the part stays already, or has to move by a constraint or by another path, or the oracle
/// refuses a step.
std::vector<Removal> around_largest(const std::vector<Removal>& plan, OrderScene& scene);

}  // namespace dismantle::order
