/// Step check: are parts put in before the covers above them?
#pragma once

#include "dismantle/geometry/part_boxes.h"
#include "dismantle/step_check.h"

namespace dismantle::checks {

/// Costs the share of the parts, seen from above, that a larger part covers which is in place already, if they are not
/// put in from above: before that part was there, they could have been reached.
class Covers final : public StepCheck {
 public:
  StepCheckTraits traits() const noexcept override { return {.reads_path = false}; }
  StepVerdict judge(const StepQuestion& question, const RunContext& context) const override;

 private:
  geometry::OfLastAssembly<geometry::PartBoxes> boxes_;
};

}  // namespace dismantle::checks
