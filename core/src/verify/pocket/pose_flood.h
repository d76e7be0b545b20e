/// Divides a box of poses until the assembled pose is cut off from its border.
#pragma once

#include <array>
#include <cstdint>
#include <queue>
#include <vector>

#include "dismantle/run_context.h"
#include "verify/pocket/contractor.h"
#include "verify/pocket/pose_cell.h"

namespace dismantle::verify {

class PoseFlood {
 public:
  enum class End {
    closed,   ///< nothing leads from the assembled pose to the border
    open,     ///< something does, though the cells are as small as cells get; or told to stop
    spent,    ///< no divisions are left; a larger box may need fewer
    at_edge,  ///< the parts get as far as the border: it has to be further out, see bounds()
  };

  /// The box from lo to hi, around 0. `in_use`: pins to begin with; more are taken as they are needed.
  PoseFlood(const Pinned& pinned, PinList in_use, const Vector6& lo, const Vector6& hi, Contractor& contractor);

  /// Makes so many divisions at most.
  End run(std::size_t most, const RunContext& context);
  const PinList& in_use() const { return in_use_; }
  std::size_t cells() const { return cells_.size(); }
  /// closed: what the assembled pose is not cut off from. at_edge, spent: a larger box.
  const PoseCell& bounds() const { return bounds_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  /// A cell, divided or not, and what the search from the assembled pose knows of it.
  struct Node {
    PoseCell cell;
    bool divided = false, border = false;
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
  double from_border(const PoseCell& cell) const;
  double extent(const PoseCell& cell) const;
  void reach(std::uint32_t node, std::uint32_t from);
  void adopt(std::uint32_t node);
  std::uint32_t next_exit();
  std::uint32_t to_divide(std::uint32_t exit) const;
  void learn_along(std::uint32_t exit);
  void learn(std::uint32_t node);
  bool within_bounds(const Vector6& x, const PoseCell& around) const;
  void note_sides(std::uint32_t exit, std::size_t round);
  std::uint32_t barred_at(std::uint32_t exit) const;
  bool wants_more(std::uint32_t exit);
  void divide(std::uint32_t node);
  std::uint32_t split(std::uint32_t node);
  void join(std::uint32_t node, std::uint32_t first);

  const Pinned& pinned_;
  Contractor& contractor_;
  PinList in_use_;
  std::vector<bool> used_;
  Vector6 lo_, hi_, scale_;
  std::vector<Node> cells_;
  std::priority_queue<Entry> queue_;
  PoseCell bounds_;
  std::array<std::size_t, 12> round_at_{};  ///< by side: when a way last led there
};

}  // namespace dismantle::verify
