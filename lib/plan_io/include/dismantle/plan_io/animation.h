/// The animation and the exploded view of a plan as binary glTF, and the precedence as Graphviz.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"

namespace dismantle {

/// plan.glb: one node per part named like the part, glTF 2.0. Two animations: "disassembly", and after it "assembly"
/// with the assembly steps; `extras` of each: `kind` (its name) and `steps`, when each step happens. In metres with Y
/// up, as glTF requires: the root node scales and turns the input as `frame` says. Below it, all is in input units and
/// axes. Congruent parts share a surface.
/// @throws InputError when the plan names a part that the assembly does not have, or a unit that is not known.
DISMANTLE_API std::vector<std::uint8_t> to_glb(const Plan& plan, const Assembly& assembly, const InputFrame& frame);
/// With input_frame(assembly), and the up of the plan if it was judged.
DISMANTLE_API std::vector<std::uint8_t> to_glb(const Plan& plan, const Assembly& assembly);

/// The parts as assembled, moved apart by exploded_offsets(); without animations. Otherwise as to_glb().
DISMANTLE_API std::vector<std::uint8_t> to_exploded_glb(const Plan& plan, const Assembly& assembly,
                                                        const InputFrame& frame);

/// precedence.dot: one node per part; an edge a -> b when a left before b and b's removal depended on it
/// as far as the attempts showed (a was touched by a failed attempt to remove b).
DISMANTLE_API std::string to_dot(const Plan& plan, const std::vector<std::pair<std::string, std::string>>& precedence);

}  // namespace dismantle
