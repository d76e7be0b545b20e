/// Both directions of the check of two solids.
#pragma once

#include "directed_check.h"

namespace dismantle::verify {

/// `forward` moves A in the frame of B, `backward` B in the frame of A; the same instants.
Finding check_pair(const Solid& a, const Solid& b, const RelativeMotion& forward, const RelativeMotion& backward,
                   const Limits& limits, Budget& budget);

}  // namespace dismantle::verify
