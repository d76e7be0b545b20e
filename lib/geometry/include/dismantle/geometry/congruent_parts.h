/// Finds parts of the same shape at different poses, and pairs of them that lie alike.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/pose.h"

namespace dismantle::geometry {

/// A part as a copy of an earlier one.
struct ShapePlacement {
  std::size_t original = 0;  ///< index of the first part of this shape; the part's own if there is none before it
  Pose pose;                 ///< maps the assembled original to this assembled part; assembly units
};

/// One per part. Two parts count as one shape when their triangles are numbered alike and a rigid displacement takes
/// each vertex of one to within 1e-4 of the part's size of the other's. Mirror images are different shapes.
DISMANTLE_API std::vector<ShapePlacement> find_congruent(const std::vector<Part>& parts);
/// The same with a tolerance in assembly units.
DISMANTLE_API std::vector<ShapePlacement> find_congruent(const std::vector<Part>& parts, double tolerance);

/// A pair of parts as a copy of an earlier pair of a list.
struct PairPlacement {
  std::size_t original = 0;  ///< index of the first pair like this one; the pair's own if there is none before it
  Pose pose;                 ///< maps the assembled original to this assembled pair; assembly units
};

/// One per pair. Two pairs are alike when their parts are congruent and lie alike, within `tolerance` (assembly units).
/// What depends on two assembled parts alone holds for all pairs that are alike.
DISMANTLE_API std::vector<PairPlacement> find_alike(const std::vector<Part>& parts,
                                                    const std::vector<std::pair<PartId, PartId>>& pairs,
                                                    double tolerance);

}  // namespace dismantle::geometry
