/// Recognises what the parts of an assembly are: the one recogniser for kinds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/fasteners/name.h"
#include "dismantle/fasteners/shape.h"
#include "dismantle/run_context.h"

namespace dismantle::fasteners {

/// What shape and name say together. Where they disagree, the surer one counts and `reason` names both.
DISMANTLE_API PartKind combined(const Shape& shape, const NameSays& name);

/// "M3x10" of a screw; otherwise the size alone, as files and people write it.
DISMANTLE_API std::string size_text(Kind kind, const std::string& size, double length);

/// Millimetres in an assembly unit. Files without a unit count as millimetres.
DISMANTLE_API double millimetres_per_unit(const Assembly& assembly);

/// The shapes of all parts; equal parts are looked at once. Deterministic on any number of threads. A plain ring inside
/// a nut, coaxial with it, is the nut's (a lock nut of two bodies). Where Part::kind is set to a screw or nut and the
/// shape does not say so, it is what shape_as() finds. @throws Error when `context` wants to stop.
DISMANTLE_API std::vector<Shape> shapes_of(const Assembly& assembly, const RunContext& context);

/// How recognise_kinds() reads an assembly.
struct KindOptions {
  bool names = true;  ///< false: by shape alone
};
/// Sets Part::kind of every part that has none yet. @throws Error when `context` wants to stop.
DISMANTLE_API void recognise_kinds(Assembly& assembly, const RunContext& context, const KindOptions& options = {});

}  // namespace dismantle::fasteners
