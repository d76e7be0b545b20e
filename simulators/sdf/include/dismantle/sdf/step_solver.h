/// One implicit step: minimises the energy of inertia (or drag), action and penalty contact with Newton's method.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "dismantle/sdf/contact_row.h"
#include "dismantle/sdf/row_columns.h"

namespace dismantle::sdf {

/// Minimises  1/2 (x - x*)^T W (x - x*) + 1/2 sum_i k_i min(0, gap_i + j_i . x)^2  over x. Piecewise quadratic, and
/// convex except for contacts on edges: Newton on the active set with step halving reaches a minimum in a few
/// iterations. Dof = 3 or 6 (one body) or Eigen::Dynamic. Allocates nothing.
template <int Dof>
class StepSolver {
 public:
  using Vector = Eigen::Matrix<double, Dof, 1, 0, Dof == Eigen::Dynamic ? kMaxDof : Dof, 1>;
  using Matrix =
      Eigen::Matrix<double, Dof, Dof, 0, Dof == Eigen::Dynamic ? kMaxDof : Dof, Dof == Eigen::Dynamic ? kMaxDof : Dof>;

  explicit StepSolver(RowColumns& columns) : columns_(columns) {}

  /// `per_body` is 3 or 6. Returns the number of Newton iterations.
  int solve(const Matrix& weight, const Vector& target, const std::vector<ContactRow>& rows, int per_body, Vector& x) {
    columns_.assign<Dof>(rows);
    x = Vector::Zero(target.size());
    double energy = energy_at(weight, target, x, false);
    Matrix hessian(target.size(), target.size());
    Vector gradient(target.size());
    int iteration = 0;
    for (; iteration < 50; ++iteration) {
      derive(weight, target, per_body, x, gradient, hessian);
      const Vector step = hessian.ldlt().solve(-gradient);
      const double slope = gradient.dot(step);
      if (!(slope < -1e-18)) break;
      double scale = 1;
      Vector next = x + step;
      const auto energy_of_next = [&] {
        columns_.try_at<Dof>(next, per_body);
        return energy_at(weight, target, next, true);
      };
      double e = energy_of_next();
      while (e > energy + 1e-4 * scale * slope && scale > 1e-6) {
        scale *= 0.5;
        next = x + scale * step;
        e = energy_of_next();
      }
      const bool converged = scale == 1 && energy - e <= 1e-12 * (1e-9 + energy) + 1e-16;
      x = next;
      columns_.keep();
      energy = e;
      if (converged) break;
    }
    return iteration;
  }

 private:
  using Entries = Eigen::Matrix<double, 6, 1>;

  /// Updates only the lower half of the symmetric matrix: LDLT reads nothing else.
  static void add_square(Matrix& h, int at, const Entries& a, int n, double k) {
    for (int c = 0; c < n; ++c)
      for (int r = c; r < n; ++r) h(at + r, at + c) += k * a[r] * a[c];
  }
  static void add_block(Matrix& h, int row0, const Entries& a, int col0, const Entries& b, int n, double k) {
    for (int c = 0; c < n; ++c)
      for (int r = 0; r < n; ++r) h(row0 + r, col0 + c) += k * a[r] * b[c];
  }

  double energy_at(const Matrix& weight, const Vector& target, const Vector& x, bool tried) const {
    const Vector off = x - target;
    double energy = 0.5 * off.dot(weight * off);
    columns_.for_each_held(tried, [&](const ContactRow& row, double g) { energy += 0.5 * row.stiffness * g * g; });
    return energy;
  }

  void derive(const Matrix& weight, const Vector& target, int per_body, const Vector& x, Vector& gradient,
              Matrix& hessian) const {
    gradient = weight * (x - target);
    hessian = weight;
    columns_.for_each_held(false, [&](const ContactRow& row, double g) {
      const double f = row.stiffness * g;
      if (row.first >= 0) {
        for (int k = 0; k < per_body; ++k) gradient[row.first + k] += f * row.j_first[k];
        add_square(hessian, row.first, row.j_first, per_body, row.stiffness);
      }
      if (row.second >= 0) {
        for (int k = 0; k < per_body; ++k) gradient[row.second + k] += f * row.j_second[k];
        add_square(hessian, row.second, row.j_second, per_body, row.stiffness);
      }
      if (row.first >= 0 && row.second >= 0) {
        add_block(hessian, row.first, row.j_first, row.second, row.j_second, per_body, row.stiffness);
        add_block(hessian, row.second, row.j_second, row.first, row.j_first, per_body, row.stiffness);
      }
    });
  }

  RowColumns& columns_;
};

}  // namespace dismantle::sdf
