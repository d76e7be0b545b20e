/// Boxes of poses, and those of them that are linked to the assembled pose.
#pragma once

#include <optional>
#include <vector>

#include "certificates/body.h"
#include "dismantle/run_context.h"

namespace dismantle::certificates {

/// A closed box: it includes its faces.
struct PoseBox {
  Vec6 lo, hi;
};

/// The box around all boxes that are linked to pose 0 by a chain of touching boxes; nullopt if no box contains 0.
/// Incomplete if the context says to stop.
std::optional<PoseBox> linked_to_zero(const std::vector<PoseBox>& boxes, const RunContext& context);

}  // namespace dismantle::certificates
