/// Penetration depths that the user allows, whatever the overlap when assembled.
#pragma once

#include <string>

#include "dismantle/assembly.h"
#include "dismantle/export.h"

namespace dismantle {

/// `depth`: assembly units, >= 0. @throws InputError when there is no such part, or both are the same.
DISMANTLE_API void declare_overlap(Assembly& assembly, const std::string& a, const std::string& b, double depth);

/// Allows every other part to cut into a flexible part (a spring, a belt, a cable, an O-ring) by its thickness as a
/// round wire: four times its volume over its surface area. Pairs with a larger overlap or a declared depth keep
/// theirs. @throws InputError when there is no such part.
DISMANTLE_API void declare_flexible(Assembly& assembly, const std::string& part);

}  // namespace dismantle
