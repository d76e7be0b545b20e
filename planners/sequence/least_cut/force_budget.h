/// How the time until the deadline is divided among forced steps, so that each part gets one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "dismantle/run_context.h"
#include "least_cut/parameters.h"

namespace dismantle::least_cut {

/// Without a deadline nothing is limited. With one, the time for quick steps of all remaining parts is reserved,
/// estimated from the slowest quick step so far. Each step gets a share of the rest; unused time is left to later
/// steps.
class ForceBudget {
 public:
  ForceBudget(const Deadline& whole, const LeastCutParameters& params, const double& slowest_quick_step)
      : whole_(whole), params_(params), quick_(slowest_quick_step) {}

  bool limited() const { return std::isfinite(whole_.seconds_left()); }
  /// For quick steps that remove all remaining parts: `overtime` beyond the deadline. Parts that need longer stay.
  Deadline for_all() const {
    return limited() ? Deadline::after_seconds(params_.overtime + whole_.seconds_left()) : whole_;
  }
  /// For finding the motion that cuts in least; `left` (> 0): number of remaining steps, this one included.
  Deadline for_measuring(std::size_t left) const { return within(1.0 / static_cast<double>(left), left); }

 private:
  Deadline within(double share, std::size_t left) const {
    const double seconds = whole_.seconds_left();
    if (!std::isfinite(seconds)) return whole_;
    return Deadline::after_seconds(share *
                                   std::max(0.0, seconds - params_.quick_margin * quick_ * static_cast<double>(left)));
  }

  Deadline whole_;
  const LeastCutParameters& params_;
  const double& quick_;  // seconds
};

}  // namespace dismantle::least_cut
