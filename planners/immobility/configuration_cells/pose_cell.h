/// Boxes of poses, and what of them pins leave over.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "dismantle/immobility/pins.h"

namespace dismantle::immobility {

using PinList = std::vector<std::uint32_t>;  // numbers of pins

/// A box of the six coordinates of Pinned. Poses of it at which a pin is inside what it faces are out of bounds.
struct PoseCell {
  Vector6 lo = Vector6::Zero(), hi = Vector6::Zero();
  bool empty = false;             ///< all of it is out of bounds
  bool center_open = false;       ///< no pin that was asked is inside at the centre
  std::shared_ptr<PinList> pins;  ///< those that may be inside somewhere
  std::size_t known = 0;          ///< so many of the pins in use have been looked at

  Vector6 center() const { return 0.5 * (lo + hi); }
  Vector6 size() const { return hi - lo; }
  bool touches(const PoseCell& other) const;
};

/// Makes the cell smaller, or empty, without loss of a pose that is within bounds; a face that does not move stays
/// exactly where it was. `in_use`: the pins to look at; it may have got longer since.
///
/// How: over the cell, each pin is in a box, to first order and with a bound of the rest (the exponential map's second
/// derivative has norm 1 at most, times the distance from the centre). What the solid leaves of that box is in half
/// spaces, so the pose is in half spaces of the six coordinates; linear programs bound what they have in common.
void contract(PoseCell& cell, const Pinned& pinned, const PinList& in_use);

}  // namespace dismantle::immobility
