/// Axes along which something may be pulled straight out.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/assembly.h"

namespace dismantle {

/// Unit vectors without their opposites: the coordinate axes, and those of the largest faces of a single part.
std::vector<Eigen::Vector3d> own_axes(const std::vector<PartId>& parts, const Assembly& assembly);

}  // namespace dismantle
