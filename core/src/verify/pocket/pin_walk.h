/// A random walk of two parts that keeps all pins out: how far they get, and what they meet.
#pragma once

#include <cstddef>

#include "dismantle/run_context.h"
#include "verify/pocket/pins.h"
#include "verify/pocket/pose_cell.h"

namespace dismantle::verify {

struct PinWalk {
  Vector6 lo = Vector6::Zero(), hi = Vector6::Zero();  ///< of the poses that were reached
  PinList met;                                         ///< pins that were in the way, sorted
  bool away = false;                                   ///< the part came further than `far`
};

/// Grows a tree of poses from the assembled one, `looks` of them looked at. Says nothing for certain: between its poses
/// it does not look, and it may not find a way that there is.
PinWalk walk_with_pins(const Pinned& pinned, std::size_t looks, double far, const RunContext& context);

}  // namespace dismantle::verify
