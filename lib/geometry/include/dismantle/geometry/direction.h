/// Directions in texts that people write.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "dismantle/export.h"

namespace dismantle {

/// How a direction is written, for messages.
inline constexpr const char* kDirectionForms = "x, y, z, -x, -y, -z or X,Y,Z";

/// The unit vector that a text says: "x", "+z", "-y", "0,0.5,1". Nothing for other texts, and for three zeros.
DISMANTLE_API std::optional<Eigen::Vector3d> direction_named(std::string_view text);

}  // namespace dismantle
