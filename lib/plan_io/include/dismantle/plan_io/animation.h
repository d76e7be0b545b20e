/// The animation of a plan as binary glTF, and the precedence as Graphviz.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/assembly.h"
#include "dismantle/plan.h"

namespace dismantle {

/// plan.glb: one node per part named like the part, glTF 2.0. Two animations: "disassembly", and after
/// it "assembly" with the assembly steps; `extras` of each: `kind` (its name) and `steps`, when each step happens.
/// Geometry in input units, in the input's axes.
DISMANTLE_API std::vector<std::uint8_t> to_glb(const Plan& plan, const Assembly& assembly);

/// precedence.dot: one node per part; an edge a -> b when a left before b and b's removal depended on it
/// as far as the attempts showed (a was touched by a failed attempt to remove b).
DISMANTLE_API std::string to_dot(const Plan& plan, const std::vector<std::pair<std::string, std::string>>& precedence);

}  // namespace dismantle
