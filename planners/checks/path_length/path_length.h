/// Step check: how far do the parts travel?
#pragma once

#include "dismantle/step_check.h"

namespace dismantle::checks {

/// Costs the length of the way of the parts' reference points, of the part that goes farthest, in largest edges of the
/// assembly's bounding box. Without a path it costs nothing.
class PathLength final : public StepCheck {
 public:
  StepCheckTraits traits() const noexcept override { return {.reads_present = false}; }
  StepVerdict judge(const StepQuestion& question, const RunContext& context) const override;
};

}  // namespace dismantle::checks
