/// Rigorous upper bounds of linear functions over polytopes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "dismantle/run_context.h"

namespace dismantle::immobility {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// All x between `lo` and `hi` with a[k] . x <= b[k]. N is 6 or Eigen::Dynamic.
template <int N>
struct PolytopeIn {
  using Vector = Eigen::Matrix<double, N, 1>;
  Vector lo, hi;
  std::vector<Vector> a;
  std::vector<double> b;

  void add(const Vector& normal, double bound) {
    a.push_back(normal);
    b.push_back(bound);
  }
};
using Polytope = PolytopeIn<6>;

template <int N>
struct LinearBoundIn {
  bool empty = false;              ///< the polytope is proved empty
  double value = 0;                ///< upper bound of the maximum; infinity if the simplex method did not converge
  Eigen::Matrix<double, N, 1> at;  ///< approximate maximum point
};
using LinearBound = LinearBoundIn<6>;

/// Rows of a polytope, and multipliers >= 0 of them.
using Multipliers = std::vector<std::pair<std::size_t, double>>;

/// Maximum of direction . x over the polytope, by the dual simplex method (Lemke 1954). The bound is computed from the
/// dual multipliers, so errors of the vertex do not matter (safe bounds: Neumaier and Shcherbina 2004). The value is
/// infinite when `context`, which may be null, says to stop. Fills `multipliers`, which may be null, with the
/// multipliers that prove the value or emptiness; multipliers of the bounds lo and hi are left out.
template <int N>
LinearBoundIn<N> maximum(const Eigen::Matrix<double, N, 1>& direction, const PolytopeIn<N>& polytope,
                         const RunContext* context = nullptr, Multipliers* multipliers = nullptr);

extern template LinearBoundIn<6> maximum(const Vector6&, const PolytopeIn<6>&, const RunContext*, Multipliers*);
extern template LinearBoundIn<Eigen::Dynamic> maximum(const Eigen::VectorXd&, const PolytopeIn<Eigen::Dynamic>&,
                                                      const RunContext*, Multipliers*);

}  // namespace dismantle::immobility
