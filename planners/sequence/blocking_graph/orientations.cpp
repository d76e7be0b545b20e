#include "blocking_graph/orientations.h"

#include <algorithm>
#include <cmath>

namespace dismantle::blocking {

std::size_t Orientations::number_of(const Eigen::Quaterniond& q) {
  // 1 - |cosine of half the angle|: angles below 3e-7 rad are rounding errors of quaternion products.
  const auto known =
      std::find_if(rotations_.begin(), rotations_.end(), [&](const auto& r) { return std::abs(r.dot(q)) > 1 - 1e-14; });
  if (known == rotations_.end()) {
    rotations_.push_back(q);
    return rotations_.size() - 1;
  }
  return static_cast<std::size_t>(known - rotations_.begin());
}

}  // namespace dismantle::blocking
