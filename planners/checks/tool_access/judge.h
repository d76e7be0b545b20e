/// Judges one step: which tools its fasteners need, and whether they have room.
#pragma once

#include <vector>

#include "dismantle/step_check.h"
#include "dismantle/tools/catalogue.h"
#include "fastener_memo.h"

namespace dismantle::checks {

/// `hand`: the hands need room, too.
StepVerdict judge_step(const FastenerMemo& memo, const std::vector<tools::Tool>& tools, bool hand,
                       const StepQuestion& question);

}  // namespace dismantle::checks
