/// What would have to bend in a forced step without a proof, in words.
#pragma once

#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/motion_depth.h"
#include "dismantle/path_oracle.h"

namespace dismantle {

/// One sentence without its full stop: a press fit, a snap, a round part that is too large for an opening, or how much
/// material is in the way. Input units. `path`: of the part `deepest.part`.
std::string hindrance_text(const Assembly& assembly, const MotionDepth& deepest, const std::vector<Pose>& path,
                           const PlacedPart& other, double tolerance);

/// The line of a configuration with which the step would be allowed or accepted, if one makes sense; else empty.
std::string suggestion_text(const Assembly& assembly, const MotionDepth& deepest, double tolerance);

}  // namespace dismantle
