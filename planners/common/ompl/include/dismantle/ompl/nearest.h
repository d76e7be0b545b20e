/// Deterministic nearest neighbours. (OMPL's trees pick pivots with generators seeded from a process-wide sequence.)
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "dismantle/geometry/numerics.h"

namespace dismantle::sampling {

/// Points labelled 0, 1, 2, ... in order of addition. Logarithmic method: k-d trees of doubling size.
class NearestNodes {
 public:
  std::uint32_t add(const Eigen::Vector3d& point);
  /// Searches ignore the label from now on.
  void remove(std::uint32_t label) { removed_[label] = true; }
  bool removed(std::uint32_t label) const { return removed_[label]; }
  /// Label with the least metric(label), the lowest label of equal ones; geometry::kNoIndex if there are none. The
  /// metric must be at least the distance from `point` to the label's point.
  std::uint32_t nearest(const Eigen::Vector3d& point, const std::function<double(std::uint32_t)>& metric) const;
  /// Up to `count` labels with the least metric, nearest first; of equal ones, the lower label first.
  std::vector<std::uint32_t> nearest(const Eigen::Vector3d& point, const std::function<double(std::uint32_t)>& metric,
                                     std::size_t count) const;
  std::size_t size() const { return points_.size(); }

 private:
  using Tree = std::vector<std::uint32_t>;  ///< implicit: the middle of each range splits it
  void build(Tree& tree, std::size_t first, std::size_t last, int axis) const;
  struct Search;
  void visit(const Tree& tree, std::size_t first, std::size_t last, int axis, Search& search) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<bool> removed_;
  std::vector<Tree> forest_;  ///< forest_[k] is empty or has 2^k entries
};

}  // namespace dismantle::sampling
