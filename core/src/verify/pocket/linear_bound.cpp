#include "verify/pocket/linear_bound.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace dismantle::verify {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int kMostPivots = 300;
constexpr double kZero = 1e-11;
constexpr double kBeside = 1e-8;

/// Rows 0 .. m-1 are the polytope's own; then the upper and the lower bound of each coordinate.
class Rows {
 public:
  explicit Rows(const Polytope& p) : p_(p), own_(p.a.size()), count_(p.a.size() + 12) {}
  std::size_t count() const { return count_; }
  std::size_t of_bound(int coordinate, bool upper) const {
    return own_ + 2 * static_cast<std::size_t>(coordinate) + (upper ? 0 : 1);
  }
  Vector6 normal(std::size_t r) const {
    if (r < own_) return p_.a[r];
    return Vector6::Unit(static_cast<int>(r - own_) / 2) * ((r - own_) % 2 == 0 ? 1.0 : -1.0);
  }
  double bound(std::size_t r) const {
    if (r < own_) return p_.b[r];
    const auto i = static_cast<Eigen::Index>((r - own_) / 2);
    return (r - own_) % 2 == 0 ? p_.hi[i] : -p_.lo[i];
  }
  /// Most that residual . x can be.
  double slack(const Vector6& residual) const {
    return residual.cwiseAbs().dot(p_.lo.cwiseAbs().cwiseMax(p_.hi.cwiseAbs()));
  }
  /// By how much `x` is beyond; own rows are not unit vectors.
  double beyond(std::size_t r, const Vector6& x) const { return normal(r).dot(x) - bound(r); }

 private:
  const Polytope& p_;
  std::size_t own_, count_;
};

}  // namespace

LinearBound maximum(const Vector6& direction, const Polytope& polytope) {
  LinearBound result;
  const Rows rows(polytope);
  // Ties make the search go in circles: it follows a direction beside the one asked for.
  Vector6 beside = direction;
  for (int i = 0; i < 6; ++i) beside[i] += kBeside * (1 + 0.37 * i) * (i % 2 == 0 ? 1 : -1);
  std::array<std::size_t, 6> basis;
  for (int i = 0; i < 6; ++i) basis[static_cast<std::size_t>(i)] = rows.of_bound(i, beside[i] >= 0);
  result.value = std::numeric_limits<double>::infinity();
  for (int pivot = 0; pivot < kMostPivots; ++pivot) {
    Matrix6 m;
    Vector6 bounds;
    for (int i = 0; i < 6; ++i) {
      m.row(i) = rows.normal(basis[static_cast<std::size_t>(i)]);
      bounds[i] = rows.bound(basis[static_cast<std::size_t>(i)]);
    }
    const Eigen::PartialPivLU<Matrix6> lu(m);
    result.at = lu.solve(bounds);
    const Eigen::PartialPivLU<Matrix6> transposed(m.transpose());
    const Vector6 y = transposed.solve(beside).cwiseMax(0.0);
    std::size_t enters = rows.count();
    double most = 1e-10;
    for (std::size_t r = 0; r < rows.count(); ++r)
      if (const double d = rows.beyond(r, result.at); d > most) most = d, enters = r;
    if (enters == rows.count()) {
      // Rounding and what lies beside: whatever the multipliers are, if none is negative, they prove a bound.
      result.value = y.dot(bounds) + rows.slack(direction - m.transpose() * y) + kZero;
      return result;
    }
    const Vector6 a = rows.normal(enters);
    const Vector6 share = transposed.solve(a);
    int leaves = -1;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 6; ++i)
      if (share[i] > 1e-9 && y[i] / share[i] < least) least = y[i] / share[i], leaves = i;
    if (leaves < 0) {
      // No multiple of the rows of the basis makes up for this one: together they cannot hold (Farkas).
      const Vector6 others = (-share).cwiseMax(0.0);
      const double sum = rows.bound(enters) + others.dot(bounds);
      result.empty = sum + rows.slack(a + m.transpose() * others) < -kZero;
      return result;
    }
    basis[static_cast<std::size_t>(leaves)] = enters;
  }
  return result;
}

}  // namespace dismantle::verify
