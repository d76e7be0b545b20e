/// Depths to which the user allows parts to be in each other, whatever they overlap when assembled.
#pragma once

#include <string>

#include "dismantle/assembly.h"
#include "dismantle/export.h"

namespace dismantle {

/// `depth`: assembly units, >= 0. @throws InputError when there is no such part, or both are the same.
DISMANTLE_API void declare_overlap(Assembly& assembly, const std::string& a, const std::string& b, double depth);

/// A flexible part (a spring, a belt, a cable, an O-ring) may be cut into by every other part as deep as its material is
/// thick, taken for a round wire: four times its volume by its surface. What overlaps more when assembled, or has a
/// depth declared, keeps that. @throws InputError when there is no such part.
DISMANTLE_API void declare_flexible(Assembly& assembly, const std::string& part);

}  // namespace dismantle
