/// Which strands are springs, and which are closed round cords.
#pragma once

#include <optional>

#include "dismantle/export.h"
#include "dismantle/flexible.h"
#include "dismantle/geometry/strand.h"

namespace dismantle::fasteners {

/// Defines coil and loop, for flexible parts and for kinds of parts. The numbers are not parameters, because a plan
/// must be verified with the same ones.
DISMANTLE_API std::optional<Flexible> strand_kind(const geometry::Strand& strand);

}  // namespace dismantle::fasteners
