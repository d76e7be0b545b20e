/// Recognises flexible parts by shape and contact (docs/concepts.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/flexible.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// How deep other parts may cut into a flexible part: its thickness as a round wire, four times its volume over its
/// surface area. Assembly units.
DISMANTLE_API double flexible_depth(const Part& part);

/// Classifies a closed mesh as `coil`, `loop` or neither, by shape alone: a rigid hoop looks like a seal.
DISMANTLE_API std::optional<Flexible> flexible_shape(const Mesh& mesh);

/// Finds coils and loops, with the parts that overlap them when assembled: for a coil all of these, for a loop those
/// that are in it along at least a quarter of its turns. Overlaps of the classes `inside` and `duplicate` do not count.
/// Sets InitialOverlap::declared of these pairs to the depth of the part, if that exceeds their overlap. If `only` is
/// given, other parts stay rigid. The overlaps of `assembly` must be measured. In the order of parts; deterministic on
/// any number of threads. @throws Error when `context` wants to stop.
DISMANTLE_API std::vector<FlexiblePart> recognise_flexible(Assembly& assembly, const RunContext& context,
                                                           const std::vector<std::string>* only = nullptr);

/// The recognised parts, and those that the file declares, that the user does not declare, followed by the parts that
/// the user declares and that are in the assembly.
DISMANTLE_API std::vector<FlexiblePart> with_declared(std::vector<FlexiblePart> recognised,
                                                      const std::vector<std::string>& declared,
                                                      const Assembly& assembly);

}  // namespace dismantle
