/// Finds parts of the same shape at different poses.
#pragma once

#include <cstddef>
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

}  // namespace dismantle::geometry
