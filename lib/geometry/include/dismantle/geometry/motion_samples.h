/// Quick sampling test for penetration. It proves no motion valid, but avoids proof attempts that must fail.
#pragma once

#include "dismantle/geometry/directed_check.h"

namespace dismantle::geometry {

/// Deepest sampled vertex of both solids over sampled times: `violated`, with its depth (0: none lies inside).
Finding deepest_sample(const Solid& a, const Solid& b, const RelativeMotion& forward, const RelativeMotion& backward);

/// Times of samples. `some`: a quarter of all, spread over the motion; `others`: the rest.
enum class SampledTimes { all, some, others };

/// True if a sample exceeds its limit, so that the motion violates the limits. Stops at the first such sample.
bool sample_beyond(const Solid& a, const Solid& b, const RelativeMotion& forward, const RelativeMotion& backward,
                   const Limits& limits, SampledTimes which = SampledTimes::all);

}  // namespace dismantle::geometry
