/// Few of the pins keep two parts where they are: those are found where they are missed.
#pragma once

#include <memory>
#include <vector>

#include "configuration_cells/pose_cell.h"
#include "dismantle/immobility/pins.h"

namespace dismantle::immobility {

/// Pins that may be inside what they face somewhere in a cell, and in the cells that it is divided into.
struct ClosePins {
  std::shared_ptr<const PinList> pins;
  double reach = 0;  ///< about so far do points get within the cell for which others were left out
};

class PinsInUse {
 public:
  PinsInUse(const Pinned& pinned, PinList begin_with);

  const PinList& list() const { return list_; }
  /// Of any cell.
  const ClosePins& all() const { return all_; }
  /// Takes the pin that is deepest inside at the centre of the cell, if there is one. `close` is kept up to date.
  void learn(const PoseCell& cell, ClosePins& close);
  /// Is no pin inside at all, in use or not? Those that may be inside somewhere in the cell around are asked first.
  bool within_bounds(const Vector6& x, const PoseCell& around) const;
  /// Straight from one pose to another, a step at a time: is no pin in use in the way?
  bool passes(const Vector6& from, const Vector6& to) const;

 private:
  void look_closer(const PoseCell& cell, const Stance& stance, ClosePins& close) const;

  const Pinned& pinned_;
  PinList list_;
  std::vector<bool> used_;
  ClosePins all_;
};

}  // namespace dismantle::immobility
