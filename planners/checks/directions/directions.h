/// Step check: does the direction of insertion change?
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/step_check.h"

namespace dismantle::checks {

struct DirectionsParameters {
  double angle = 0.1;
  double preference = 0;
  static void describe(Schema<DirectionsParameters>& s);
};

/// Costs 1 when parts are put in along another direction than in the operation before; and `preference` times 1 along
/// no main axis, 2/3 from below, 1/3 from the side, 0 from above. A rotation in place has no direction, and costs
/// nothing.
class Directions final : public StepCheck {
 public:
  explicit Directions(const DirectionsParameters& params = {}) : params_(params) {}
  StepCheckTraits traits() const noexcept override {
    return {.remembers_direction = true, .reads_present = false, .reads_path = false};
  }
  StepVerdict judge(const StepQuestion& question, const RunContext& context) const override;

 private:
  DirectionsParameters params_;
};

}  // namespace dismantle::checks
