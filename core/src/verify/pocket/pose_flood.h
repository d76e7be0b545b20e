/// Divides a box of poses until the assembled pose is cut off from its border. The box grows where the parts get there.
#pragma once

#include <cstdint>
#include <queue>
#include <vector>

#include "dismantle/run_context.h"
#include "verify/pocket/contractor.h"
#include "verify/pocket/pin_walk.h"
#include "verify/pocket/pins_in_use.h"
#include "verify/pocket/pose_box.h"
#include "verify/pocket/pose_cell.h"

namespace dismantle::verify {

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
  PoseFlood(const Pinned& pinned, PinWalk& walk, const Limits& limits, Contractor& contractor);

  /// Makes so many divisions at most.
  End run(std::size_t most, const RunContext& context);
  std::size_t cells() const { return cells_.size(); }
  /// closed: what the assembled pose is not cut off from.
  const PoseCell& bounds() const { return bounds_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  /// A cell, divided or not, and what the search from the assembled pose knows of it.
  struct Node {
    PoseCell cell;
    bool divided = false, border = false;
    ClosePins close;
    bool asked = false;  ///< all pins were asked at the centre
    bool reached = false, expanded = false;
    std::uint32_t from = kNone, stamp = 0;
    std::vector<std::uint32_t> on, near;  ///< reached from here; neighbours
  };
  struct Entry {
    double key;
    std::uint32_t node, stamp;
    bool operator<(const Entry& o) const { return key > o.key || (key == o.key && node > o.node); }
  };

  bool at_border(const PoseCell& cell) const;
  double extent(const PoseCell& cell) const;
  void reach(std::uint32_t node, std::uint32_t from);
  void adopt(std::uint32_t node);
  std::uint32_t next_exit();
  std::uint32_t to_divide(std::uint32_t exit) const;
  void learn_along(std::uint32_t exit);
  std::uint32_t barred_at(std::uint32_t exit) const;
  PoseBox::Sides sides_reached(std::uint32_t exit) const;
  void grow(const PoseBox::Sides& sides);
  bool hopeless() const;
  bool closed();
  void divide(std::uint32_t node);
  std::uint32_t split(std::uint32_t node);
  void befriend(std::uint32_t x, std::uint32_t y);
  void join(std::uint32_t node, std::uint32_t first);

  const Pinned& pinned_;
  PinWalk& walk_;
  Limits limits_;
  Contractor& contractor_;
  PinsInUse in_use_;
  Vector6 scale_;
  PoseBox box_;
  std::vector<Node> cells_;
  std::priority_queue<Entry> queue_;
  PoseCell bounds_;
  std::size_t sent_at_ = 0, pause_;  ///< the round in which the walk was last sent; how long until the next time
};

}  // namespace dismantle::verify
