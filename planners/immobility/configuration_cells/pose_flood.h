/// Divides a box of poses until the assembled pose is cut off from its border. The box grows where the parts get there.
#pragma once

#include <cstdint>

#include "configuration_cells/pin_walk.h"
#include "configuration_cells/pins_in_use.h"
#include "configuration_cells/pose_box.h"
#include "configuration_cells/pose_cell.h"
#include "dismantle/executor.h"
#include "dismantle/immobility/cell_graph.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

class PoseFlood {
 public:
  enum class End {
    closed,  ///< nothing leads from the assembled pose to the border
    open,    ///< something does, as far as can be told; or the parts come further than the limits; or told to stop
    spent,   ///< no divisions are left
  };

  /// How far parts may come, either way, in any coordinate: rad, and assembly units.
  struct Limits {
    double turn, shift;
  };

  /// Begins with a box that holds what the walk has reached, and with the pins that it met; more are taken as they are
  /// needed. The walk is sent further where ways lead to.
  PoseFlood(const Pinned& pinned, PinWalk& walk, const Limits& limits, ForkJoin& both);

  /// Makes so many divisions at most.
  End run(std::size_t most, const RunContext& context);
  std::size_t cells() const { return cells_.size(); }
  /// closed: what the assembled pose is not cut off from.
  const PoseCell& bounds() const { return bounds_; }

 private:
  struct Cell : PoseCell {
    ClosePins close;
    bool asked = false;  ///< all pins were asked at the centre
  };
  using Graph = CellGraph<Cell>;
  static constexpr std::uint32_t kNone = Graph::kNone;

  Cell first_cell() const;
  CellPlace place(const PoseCell& cell) const;
  double extent(const PoseCell& cell) const;
  std::uint32_t to_divide(std::uint32_t exit) const;
  void learn_along(std::uint32_t exit);
  std::uint32_t barred_at(std::uint32_t exit) const;
  PoseBox::Sides sides_reached(std::uint32_t exit) const;
  void grow(const PoseBox::Sides& sides);
  bool hopeless() const;
  bool closed();
  void divide(std::uint32_t node);

  const Pinned& pinned_;
  PinWalk& walk_;
  Limits limits_;
  ForkJoin& both_;
  PinsInUse in_use_;
  Vector6 scale_;
  PoseBox box_;
  Graph cells_;
  PoseCell bounds_;
  std::size_t sent_at_ = 0, pause_;  ///< the round in which the walk was last sent; how long until the next time
};

}  // namespace dismantle::immobility
