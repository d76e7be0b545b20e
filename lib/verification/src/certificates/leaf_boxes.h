/// Boxes of poses, and which of them are linked to the assembled pose.
#pragma once

#include <optional>
#include <vector>

#include "certificates/body.h"
#include "dismantle/run_context.h"

namespace dismantle::certificates {

/// Closed: with its faces.
struct PoseBox {
  Vec6 lo, hi;
};

/// The box around all that are linked to the pose 0 by others, each of which touches the next; nothing: 0 is in none.
/// Something, if the context says to stop.
std::optional<PoseBox> linked_to_zero(const std::vector<PoseBox>& boxes, const RunContext& context);

}  // namespace dismantle::certificates
