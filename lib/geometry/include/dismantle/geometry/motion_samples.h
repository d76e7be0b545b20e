/// A quick test for penetrations by samples. It proves nothing, but avoids proofs that must fail.
#pragma once

#include "dismantle/geometry/directed_check.h"

namespace dismantle::geometry {

/// The deepest of some vertices of both solids at some times: `violated`, with its depth (0: none lies inside).
Finding deepest_sample(const Solid& a, const Solid& b, const RelativeMotion& forward, const RelativeMotion& backward);

/// At which times samples are taken: `some` is a quarter of all, spread over the motion.
enum class SampledTimes { all, some, others };

/// Is a sample deeper than the limits allow? Then the motion certainly violates them. Stops at the first such sample.
bool sample_beyond(const Solid& a, const Solid& b, const RelativeMotion& forward, const RelativeMotion& backward,
                   const Limits& limits, SampledTimes which = SampledTimes::all);

}  // namespace dismantle::geometry
