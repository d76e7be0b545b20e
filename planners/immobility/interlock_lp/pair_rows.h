/// What the pins of two bodies say of where one is seen from the other, near where they are assembled.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/immobility/pins.h"

namespace dismantle::immobility {

/// normal . x <= most, of the six coordinates of Pinned.
struct PairRow {
  Vector6 normal = Vector6::Zero();
  double most = 0;
};

/// Of all poses between lo (< 0) and hi (> 0): half spaces that hold those at which no pin is inside what it faces.
/// Here the coordinates are along `axes` (assembled = axes * ours).
///
/// How: pins are linear in the coordinates to first order about the assembled pose, with a bound of the rest by
/// components; so each stays in a box, and what the solid leaves of that box is in half spaces (free_part()).
std::vector<PairRow> pair_rows(const Pinned& pinned, const Eigen::Quaterniond& axes, const Vector6& lo,
                               const Vector6& hi);

}  // namespace dismantle::immobility
