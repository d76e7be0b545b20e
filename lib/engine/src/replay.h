/// Steps of an earlier disassembly, verified and recorded again.
#pragma once

#include "dismantle/disassembly.h"
#include "oracle.h"
#include "recorder.h"

namespace dismantle {

/// Proposes each step to the oracle and records the answer. @throws StepRefused for a step that is not valid or that a
/// constraint forbids. Ends early when `context` asks to stop.
void replay(const Disassembly& earlier, const Assembly& assembly, const Constraints& constraints, Oracle& oracle,
            Recorder& recorder, RunContext& context);

}  // namespace dismantle
