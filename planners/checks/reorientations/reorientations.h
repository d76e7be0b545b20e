/// Step check: does the assembly have to be turned over?
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/step_check.h"

namespace dismantle::checks {

struct ReorientationsParameters {
  double angle = 0.1;
  static void describe(Schema<ReorientationsParameters>& s);
};

/// Costs 1 when the whole lies differently than in the operation before, and says so in a note.
class Reorientations final : public StepCheck {
 public:
  explicit Reorientations(const ReorientationsParameters& params = {}) : params_(params) {}
  StepCheckTraits traits() const noexcept override {
    return {.remembers_orientation = true, .reads_present = false, .reads_path = false};
  }
  StepVerdict judge(const StepQuestion& question, const RunContext& context) const override;

 private:
  ReorientationsParameters params_;
};

}  // namespace dismantle::checks
