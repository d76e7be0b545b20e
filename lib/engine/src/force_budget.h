/// How the time until the deadline is divided among forced steps: each gets its turn, and so the answer is whole.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "dismantle/run_context.h"

namespace dismantle {

/// Without a deadline nothing is limited. With one, the time that quick steps for all that is left would take is kept,
/// as it was measured so far; each step gets its share of the rest, and what it does not use is left to those after it.
class ForceBudget {
 public:
  explicit ForceBudget(const Deadline& whole) : whole_(whole) {}

  bool limited() const { return std::isfinite(whole_.seconds_left()); }
  /// For quick steps, by which all parts get out: a second beyond the deadline, so that a run still ends within two
  /// seconds of it. Parts for which that is not enough stay.
  Deadline for_all() const { return limited() ? Deadline::after_seconds(kOvertime + whole_.seconds_left()) : whole_; }
  /// A quick step took so long.
  void took(double seconds) { quick_ = std::max(quick_, seconds); }
  /// For finding the motion of a step that cuts in least; `left` (> 0): steps that are left, this one included.
  Deadline for_measuring(std::size_t left) const { return within(1.0 / static_cast<double>(left), left); }
  /// For verified steps before or after it.
  Deadline for_planning(std::size_t left) const {
    return within(std::max(kPlanning, 1.0 / static_cast<double>(left + 1)), left);
  }

 private:
  static constexpr double kOvertime = 1;     // seconds
  static constexpr double kSafety = 2;       // quick steps may take longer than those before
  static constexpr double kPlanning = 0.25;  // of the time that is free

  Deadline within(double share, std::size_t left) const {
    const double seconds = whole_.seconds_left();
    if (!std::isfinite(seconds)) return whole_;
    return Deadline::after_seconds(share * std::max(0.0, seconds - kSafety * quick_ * static_cast<double>(left)));
  }

  Deadline whole_;
  double quick_ = 0;  // seconds, the longest so far
};

}  // namespace dismantle
