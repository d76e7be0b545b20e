/// Bounds of linear functions over polytopes of six dimensions, as certain as arithmetic is.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace dismantle::verify {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// All x between `lo` and `hi` with a[k] . x <= b[k].
struct Polytope {
  Vector6 lo = Vector6::Zero(), hi = Vector6::Zero();
  std::vector<Vector6> a;
  std::vector<double> b;

  void add(const Vector6& normal, double bound) {
    a.push_back(normal);
    b.push_back(bound);
  }
};

struct LinearBound {
  bool empty = false;            ///< certain: the polytope has no point
  double value = 0;              ///< no point of it has more; infinity where the search was given up
  Vector6 at = Vector6::Zero();  ///< about where that is reached
};

/// Of direction . x over the polytope. Dual simplex method: the bound is made of the multipliers, not of the vertex.
LinearBound maximum(const Vector6& direction, const Polytope& polytope);

}  // namespace dismantle::verify
