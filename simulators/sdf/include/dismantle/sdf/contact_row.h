/// Contacts as rows of a linear system in the displacement of all bodies.
#pragma once

#include <Eigen/Core>

namespace dismantle::sdf {

constexpr int kMaxBodies = 8;
constexpr int kMaxDof = 6 * kMaxBodies;

/// Row of a contact in the generalised displacement x of all bodies: gap(x) = gap + j . x. It involves at most two
/// bodies; `first` and `second` are the indices of their first degrees of freedom, -1 = none. A contact on a convex
/// edge has several consecutive rows, and its gap is the largest of theirs; `alternatives` counts the rows that follow.
struct ContactRow {
  double gap = 0;
  double stiffness = 0;
  int first = -1, second = -1;
  int alternatives = 0;
  Eigen::Matrix<double, 6, 1> j_first, j_second;  ///< only the first `dof per body` entries are used

  /// gap(x); `per_body` is 3 or 6.
  template <class Vector>
  double gap_at(const Vector& x, int per_body) const {
    double g = gap;
    if (first >= 0)
      for (int k = 0; k < per_body; ++k) g += j_first[k] * x[first + k];
    if (second >= 0)
      for (int k = 0; k < per_body; ++k) g += j_second[k] * x[second + k];
    return g;
  }
};

}  // namespace dismantle::sdf
