/// One implicit step: the energy of inertia (or drag), action and penalty contact, minimised by Newton.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "dismantle/sdf/contact_row.h"

namespace dismantle::sdf {

/// Minimises  1/2 (x - x*)^T W (x - x*) + 1/2 sum_i k_i min(0, gap_i + j_i . x)^2  over x.
/// Piecewise quadratic, and convex but for contacts on edges: Newton on the active set with step halving
/// ends at a minimum in a few iterations. Dof = 3 or 6 (one body) or Eigen::Dynamic. Allocates nothing.
template <int Dof>
class StepSolver {
 public:
  using Vector = Eigen::Matrix<double, Dof, 1, 0, Dof == Eigen::Dynamic ? kMaxDof : Dof, 1>;
  using Matrix =
      Eigen::Matrix<double, Dof, Dof, 0, Dof == Eigen::Dynamic ? kMaxDof : Dof, Dof == Eigen::Dynamic ? kMaxDof : Dof>;

  /// `per_body` is 3 or 6. Returns the number of Newton iterations.
  int solve(const Matrix& weight, const Vector& target, const std::vector<ContactRow>& rows, int per_body, Vector& x) {
    x = Vector::Zero(target.size());
    double energy = evaluate(weight, target, rows, per_body, x, nullptr, nullptr);
    Matrix hessian(target.size(), target.size());
    Vector gradient(target.size());
    int iteration = 0;
    for (; iteration < 50; ++iteration) {
      evaluate(weight, target, rows, per_body, x, &gradient, &hessian);
      const Vector step = hessian.ldlt().solve(-gradient);
      const double slope = gradient.dot(step);
      if (!(slope < -1e-18)) break;
      double scale = 1;
      Vector next = x + step;
      double e = evaluate(weight, target, rows, per_body, next, nullptr, nullptr);
      while (e > energy + 1e-4 * scale * slope && scale > 1e-6) {
        scale *= 0.5;
        next = x + scale * step;
        e = evaluate(weight, target, rows, per_body, next, nullptr, nullptr);
      }
      const bool converged = scale == 1 && energy - e <= 1e-12 * (1e-9 + energy) + 1e-16;
      x = next;
      energy = e;
      if (converged) break;
    }
    return iteration;
  }

 private:
  static void add_block(Matrix& h, int row0, const Eigen::Matrix<double, 6, 1>& a, int col0,
                        const Eigen::Matrix<double, 6, 1>& b, int n, double k) {
    for (int c = 0; c < n; ++c)
      for (int r = 0; r < n; ++r) h(row0 + r, col0 + c) += k * a[r] * b[c];
  }

  double evaluate(const Matrix& weight, const Vector& target, const std::vector<ContactRow>& rows, int per_body,
                  const Vector& x, Vector* gradient, Matrix* hessian) const {
    const Vector off = x - target;
    const Vector pull = weight * off;
    double energy = 0.5 * off.dot(pull);
    if (gradient != nullptr) {
      *gradient = pull;
      *hessian = weight;
    }
    for (std::size_t i = 0; i < rows.size(); i += 1 + static_cast<std::size_t>(rows[i].alternatives)) {
      std::size_t best = i;
      double g = rows[i].gap_at(x, per_body);
      for (std::size_t k = 1; g < 0 && k <= static_cast<std::size_t>(rows[i].alternatives); ++k)
        if (const double other = rows[i + k].gap_at(x, per_body); other > g) g = other, best = i + k;
      if (g >= 0) continue;
      const ContactRow& row = rows[best];
      energy += 0.5 * row.stiffness * g * g;
      if (gradient == nullptr) continue;
      const double f = row.stiffness * g;
      if (row.first >= 0) {
        for (int k = 0; k < per_body; ++k) (*gradient)[row.first + k] += f * row.j_first[k];
        add_block(*hessian, row.first, row.j_first, row.first, row.j_first, per_body, row.stiffness);
      }
      if (row.second >= 0) {
        for (int k = 0; k < per_body; ++k) (*gradient)[row.second + k] += f * row.j_second[k];
        add_block(*hessian, row.second, row.j_second, row.second, row.j_second, per_body, row.stiffness);
      }
      if (row.first >= 0 && row.second >= 0) {
        add_block(*hessian, row.first, row.j_first, row.second, row.j_second, per_body, row.stiffness);
        add_block(*hessian, row.second, row.j_second, row.first, row.j_first, per_body, row.stiffness);
      }
    }
    return energy;
  }
};

}  // namespace dismantle::sdf
