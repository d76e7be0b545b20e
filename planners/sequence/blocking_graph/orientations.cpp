#include "blocking_graph/orientations.h"

#include <algorithm>
#include <cmath>

namespace dismantle::blocking {
namespace {

constexpr double kSameRotation = 1e-14;  // 1 - |cosine of half the angle between two|

}  // namespace

std::size_t Orientations::number_of(const Eigen::Quaterniond& q) {
  const auto known = std::find_if(rotations_.begin(), rotations_.end(),
                                  [&](const auto& r) { return std::abs(r.dot(q)) > 1 - kSameRotation; });
  if (known == rotations_.end()) {
    rotations_.push_back(q);
    return rotations_.size() - 1;
  }
  return static_cast<std::size_t>(known - rotations_.begin());
}

}  // namespace dismantle::blocking
