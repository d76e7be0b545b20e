/// How the time until the deadline is divided among forced steps, so that each part gets one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "dismantle/engine/force_options.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// Without a deadline nothing is limited. With one, the time that quick steps for all that is left would take is kept,
/// as it was measured so far; each step gets its share of the rest, and what it does not use is left to those after it.
class ForceBudget {
 public:
  ForceBudget(const Deadline& whole, const ForceOptions& options) : whole_(whole), options_(options) {}

  bool limited() const { return std::isfinite(whole_.seconds_left()); }
  /// For quick steps, by which all parts get out: somewhat beyond the deadline. Parts for which that is not enough
  /// stay.
  Deadline for_all() const {
    return limited() ? Deadline::after_seconds(options_.overtime + whole_.seconds_left()) : whole_;
  }
  /// Reports how long a quick step took.
  void took(double seconds) { quick_ = std::max(quick_, seconds); }
  /// For finding the motion of a step that cuts in least; `left` (> 0): steps that are left, this one included.
  Deadline for_measuring(std::size_t left) const { return within(1.0 / static_cast<double>(left), left); }
  /// For verified steps before or after it.
  Deadline for_planning(std::size_t left) const {
    return within(std::max(options_.verified_share, 1.0 / static_cast<double>(left + 1)), left);
  }

 private:
  Deadline within(double share, std::size_t left) const {
    const double seconds = whole_.seconds_left();
    if (!std::isfinite(seconds)) return whole_;
    return Deadline::after_seconds(share *
                                   std::max(0.0, seconds - options_.quick_margin * quick_ * static_cast<double>(left)));
  }

  Deadline whole_;
  ForceOptions options_;
  double quick_ = 0;  // seconds, the longest so far
};

}  // namespace dismantle
