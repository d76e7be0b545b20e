/// Recognises what the parts of an assembly are: the one recogniser for kinds.
#pragma once

#include <optional>
#include <string>
#include <string_view>
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

/// Advance in mm per turn of a thread by its size: that of the coarse thread of the tables ("M6x14": 1), or the one
/// that the size states ("M8x1x20", "1/4-20"). 0: in no table.
DISMANTLE_API double pitch_of(std::string_view size);

/// Millimetres in an assembly unit. Files without a unit count as millimetres.
DISMANTLE_API double millimetres_per_unit(const Assembly& assembly);

/// The shapes of all parts; equal parts are looked at once. Deterministic on any number of threads. A plain ring inside
/// a nut, coaxial with it, is the nut's (a lock nut of two bodies). Where Part::kind is set to a screw or nut and the
/// shape does not say so, it is what shape_as() finds. @throws Error when `context` wants to stop.
DISMANTLE_API std::vector<Shape> shapes_of(const Assembly& assembly, const RunContext& context);
/// The same for fastenings_of(), nuts_on_rods() and patterns_of(), which need the shapes of screws and nuts only: parts
/// whose Part::kind is another one are not looked at.
DISMANTLE_API std::vector<Shape> fastener_shapes(const Assembly& assembly, const RunContext& context);

/// How recognise_kinds() reads an assembly.
struct KindOptions {
  bool names = true;  ///< false: by shape alone
};
/// Sets Part::kind of every part that has none yet. @throws Error when `context` wants to stop.
DISMANTLE_API void recognise_kinds(Assembly& assembly, const RunContext& context, const KindOptions& options = {});

}  // namespace dismantle::fasteners
