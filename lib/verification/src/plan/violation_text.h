/// Why a motion is refused, in words.
#pragma once

#include <string>

#include "dismantle/assembly.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// "'pin' penetrates 'hub' by 0.2 mm (0 when assembled) between poses 3 and 4, at [1, 2, 3] of 'pin'". Input units.
std::string violation_text(const Violation& violation, const Assembly& assembly);

}  // namespace dismantle
