/// Patterns of equal screws that clamp one part, which are tightened crosswise.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/fasteners/fastening.h"
#include "dismantle/fasteners/shape.h"

namespace dismantle::fasteners {

/// At least four equal screws, side by side and not in a line.
struct Pattern {
  std::vector<PartId> screws;  ///< in cross order: after each one the one opposite
  std::vector<PartId> clamps;  ///< the same parts by all of them; washers and spacers are left out
  std::string size;            ///< "M3x10"
};

/// `shapes`: of all parts. Screws of unknown size belong to no pattern.
DISMANTLE_API std::vector<Pattern> patterns_of(const Assembly& assembly, std::span<const Fastening> fastenings,
                                               std::span<const Shape> shapes);

}  // namespace dismantle::fasteners
