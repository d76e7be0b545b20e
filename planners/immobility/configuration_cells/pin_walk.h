/// A random walk of two parts that keeps all pins out: how far they get, and what they meet.
#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <vector>

#include "configuration_cells/pose_cell.h"
#include "dismantle/immobility/pins.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

/// Grows a tree of poses from the assembled one. Says nothing for certain: between its poses it does not look, and it
/// may not find a way that there is.
class PinWalk {
 public:
  /// Parts that come further than `far` have come away.
  PinWalk(const Pinned& pinned, double far);

  /// Looks at so many poses, in all directions.
  void wander(std::size_t looks, const RunContext& context);
  /// Looks at so many poses, on the way to that one and beyond.
  void lead(const Vector6& to, std::size_t looks, const RunContext& context);
  /// The parts get there, too.
  void add(const Vector6& pose);

  bool away() const { return away_; }
  const Vector6& lo() const { return lo_; }  ///< of the poses that were reached
  const Vector6& hi() const { return hi_; }
  PinList met() const { return {met_.begin(), met_.end()}; }  ///< pins that were in the way, sorted

 private:
  bool open(const Vector6& x);
  Vector6 any_way();
  Vector6 apart();
  double dot(const Vector6& x, const Vector6& y) const;  ///< in assembly units, squared
  double length(const Vector6& x) const;
  std::vector<std::size_t> nearest(const Vector6& to) const;
  std::size_t fly(std::size_t from, const Vector6& step);
  void slide(std::size_t from, const Vector6& way, std::size_t until);

  const Pinned& pinned_;
  double far_;
  Rng rng_{7};
  bool away_ = false;
  Vector6 lo_ = Vector6::Zero(), hi_ = Vector6::Zero();
  std::vector<std::uint32_t> order_;
  std::vector<Vector6> poses_;
  std::array<std::size_t, 12> furthest_{};
  std::set<std::uint32_t> met_;
  std::size_t looks_ = 0;
};

}  // namespace dismantle::immobility
