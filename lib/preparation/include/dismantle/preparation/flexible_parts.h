/// Parts that bend, told by their shape and by what they are in contact with (docs/concepts.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/flexible.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// How deep a flexible part may be cut into: as its material is thick, taken for a round wire: four times its volume by
/// its surface. Assembly units.
DISMANTLE_API double flexible_depth(const Part& part);

/// `coil` or `loop`, or none, of a closed mesh. From its shape alone: a rigid hoop looks as a seal does.
DISMANTLE_API std::optional<Flexible> flexible_shape(const Mesh& mesh);

/// Parts whose shape is that of a coil or a loop, with those that they overlap when assembled, but for what lies in the
/// solid of another: a coil with all of them, a loop with those that are in it along a quarter of its turns or more.
/// Sets InitialOverlap::declared of these pairs to the depth of the part, where it is more than they overlap. Parts
/// that are not in `only`, if given, stay rigid. `assembly` has its overlaps measured. In the order of parts;
/// deterministic on any number of threads. @throws Error when `context` wants to stop.
DISMANTLE_API std::vector<FlexiblePart> recognise_flexible(Assembly& assembly, const RunContext& context,
                                                           const std::vector<std::string>* only = nullptr);

/// What the user declared, as far as it is in the assembly, after those of `recognised` that are not declared.
DISMANTLE_API std::vector<FlexiblePart> with_declared(std::vector<FlexiblePart> recognised,
                                                      const std::vector<std::string>& declared,
                                                      const Assembly& assembly);

}  // namespace dismantle
