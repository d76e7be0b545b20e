/// Boxes of relative poses, and the contraction of a box to its free poses.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "configuration_cells/contraction.h"
#include "dismantle/immobility/interior_samples.h"

namespace dismantle::immobility {

using SampleList = std::vector<std::uint32_t>;  ///< indices of interior samples

/// A box in the six coordinates of SampledPair. A pose at which a sample is inside its obstacle is not free.
struct PoseCell {
  Vector6 lo = Vector6::Zero(), hi = Vector6::Zero();
  bool empty = false;                   ///< no pose of it is free
  bool center_free = false;             ///< no active sample is inside at the centre
  std::shared_ptr<SampleList> samples;  ///< active samples that may be inside somewhere in the cell
  std::size_t known = 0;                ///< length of the prefix of the active samples that `samples` accounts for

  Vector6 center() const { return 0.5 * (lo + hi); }
  Vector6 size() const { return hi - lo; }
  bool touches(const PoseCell& other) const;
};

/// Makes the cell smaller, or empty, without loss of a free pose. A face that does not move keeps its exact coordinate.
/// `active`: samples to use; the list may only grow between calls. Appends the moves to `made`.
///
/// Over the cell, the first order form of a sample's position and a bound of the remainder give a box that contains the
/// sample (the second derivative of the exponential map has norm 1 at most, times the distance from the centre).
/// free_space_bound() of that box gives half spaces of the six coordinates, and linear programs bound their
/// intersection with the cell.
void contract(PoseCell& cell, const SampledPair& pair, const SampleList& active, Contraction& made);

}  // namespace dismantle::immobility
