/// Numbers rotations, so that results for rotated parts can be cached by key.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace dismantle::blocking {

/// Rotations from the assembled orientation. Number 0 is the identity; equal rotations have equal numbers.
class Orientations {
 public:
  std::size_t number_of(const Eigen::Quaterniond& q);
  const Eigen::Quaterniond& operator[](std::size_t number) const { return rotations_[number]; }

 private:
  std::vector<Eigen::Quaterniond> rotations_{Eigen::Quaterniond::Identity()};
};

}  // namespace dismantle::blocking
