/// Judges one step: which tools its fasteners need, and whether they have room.
#pragma once

#include <vector>

#include "dismantle/step_check.h"
#include "dismantle/tools/catalogue.h"
#include "fastener_memo.h"

namespace dismantle::checks {

/// What there is to work with.
struct Bench {
  const std::vector<tools::Tool>& tools;
  const std::vector<tools::Tool>& left_out;  ///< of the catalogue; only named where none of `tools` reaches
  bool hand;                                 ///< the hands need room, too
};

StepVerdict judge_step(const FastenerMemo& memo, const Bench& bench, const StepQuestion& question);

}  // namespace dismantle::checks
