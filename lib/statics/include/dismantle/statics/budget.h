/// Counted work, so that what takes too long ends, and ends at the same point whenever it is asked.
#pragma once

#include <algorithm>

#include "dismantle/statics/balance.h"

namespace dismantle::statics {

/// A number of multiplications, of which all balances of this thread take.
class Budget {
 public:
  explicit Budget(double most) : end_(work_done() + most) {}
  double left() const { return std::max(0.0, end_ - work_done()); }
  bool spent() const { return work_done() > end_; }

 private:
  double end_;
};

}  // namespace dismantle::statics
