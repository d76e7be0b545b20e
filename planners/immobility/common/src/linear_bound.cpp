#include "dismantle/immobility/linear_bound.h"

#include <Eigen/LU>
#include <cmath>
#include <cstddef>
#include <limits>

namespace dismantle::immobility {
namespace {

// Rounding of the final sums. Coordinates are angles and shifts of parts, of order 1 or less. A hundredth of
// geometry::kRounding: with kRounding itself, a proof about four parts took twelve times as long, and failed.
constexpr double kSumRounding = 1e-11;

/// Rows 0 .. m-1 are the polytope's own; then the upper and the lower bound of each coordinate.
template <int N>
class Rows {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  explicit Rows(const PolytopeIn<N>& p)
      : p_(p), own_(p.a.size()), count_(p.a.size() + 2 * static_cast<std::size_t>(p.lo.size())) {}
  std::size_t count() const { return count_; }
  std::size_t of_bound(Eigen::Index coordinate, bool upper) const {
    return own_ + 2 * static_cast<std::size_t>(coordinate) + (upper ? 0 : 1);
  }
  Vector normal(std::size_t r) const {
    if (r < own_) return p_.a[r];
    return Vector::Unit(p_.lo.size(), coordinate(r)) * sign(r);
  }
  double bound(std::size_t r) const {
    if (r < own_) return p_.b[r];
    return sign(r) > 0 ? p_.hi[coordinate(r)] : -p_.lo[coordinate(r)];
  }
  /// Upper bound of residual . x.
  double slack(const Vector& residual) const {
    return residual.cwiseAbs().dot(p_.lo.cwiseAbs().cwiseMax(p_.hi.cwiseAbs()));
  }
  /// Amount by which `x` violates the row. Rows of the polytope are not unit vectors.
  double violation(std::size_t r, const Vector& x) const {
    return r < own_ ? p_.a[r].dot(x) - p_.b[r] : sign(r) * x[coordinate(r)] - bound(r);
  }

 private:
  Eigen::Index coordinate(std::size_t r) const { return static_cast<Eigen::Index>((r - own_) / 2); }
  double sign(std::size_t r) const { return (r - own_) % 2 == 0 ? 1.0 : -1.0; }

  const PolytopeIn<N>& p_;
  std::size_t own_, count_;
};

}  // namespace

template <int N>
LinearBoundIn<N> maximum(const Eigen::Matrix<double, N, 1>& direction, const PolytopeIn<N>& polytope,
                         const RunContext* context, Multipliers* multipliers) {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  const Eigen::Index n = direction.size();
  LinearBoundIn<N> result;
  result.at.setZero(n);
  if (multipliers != nullptr) multipliers->clear();
  const Rows<N> rows(polytope);
  // Ties can make the simplex method cycle, so the objective is perturbed. The bound below accounts for that.
  Vector perturbed = direction;
  for (Eigen::Index i = 0; i < n; ++i)
    perturbed[i] += 1e-8 * (1 + 0.37 * static_cast<double>(i)) * (i % 2 == 0 ? 1 : -1);
  Eigen::Matrix<std::size_t, N, 1> basis(n);
  for (Eigen::Index i = 0; i < n; ++i) basis[i] = rows.of_bound(i, perturbed[i] >= 0);
  result.value = std::numeric_limits<double>::infinity();
  const auto keep = [&](const Vector& y) {
    for (Eigen::Index i = 0; i < n && multipliers != nullptr; ++i)
      if (basis[i] < polytope.a.size() && y[i] > 0) multipliers->emplace_back(basis[i], y[i]);
  };
  Matrix m(n, n);
  Vector bounds(n);
  for (Eigen::Index pivot = 0; pivot < 50 * n; ++pivot) {  // mostly a few times n are enough
    if (context != nullptr && context->should_stop()) break;
    for (Eigen::Index i = 0; i < n; ++i) {
      m.row(i) = rows.normal(basis[i]);
      bounds[i] = rows.bound(basis[i]);
    }
    const Eigen::PartialPivLU<Matrix> lu(m);
    result.at = lu.solve(bounds);
    Vector y = lu.transpose().solve(perturbed);
    y = y.cwiseMax(0.0);
    std::size_t enters = rows.count();
    double most = 10 * kSumRounding;
    for (std::size_t r = 0; r < rows.count(); ++r)
      if (const double d = rows.violation(r, result.at); d > most) most = d, enters = r;
    if (enters == rows.count()) {
      // Any multipliers that are not negative prove a bound. The residual covers rounding and the perturbation.
      keep(y);
      result.value = y.dot(bounds) + rows.slack(direction - m.transpose() * y) + kSumRounding;
      return result;
    }
    const Vector a = rows.normal(enters);
    const Vector share = lu.transpose().solve(a);
    Eigen::Index leaves = -1;
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < n; ++i)
      if (share[i] > 1e-9 && y[i] / share[i] < least) least = y[i] / share[i], leaves = i;
    if (leaves < 0) {
      // By Farkas' lemma the rows have no common point, if the sum below is certainly negative.
      const Vector others = (-share).cwiseMax(0.0);
      const double sum = rows.bound(enters) + others.dot(bounds);
      result.empty = sum + rows.slack(a + m.transpose() * others) < -kSumRounding;
      keep(others);
      if (multipliers != nullptr && enters < polytope.a.size()) multipliers->emplace_back(enters, 1.0);
      return result;
    }
    basis[leaves] = enters;
  }
  return result;
}

template LinearBoundIn<6> maximum(const Vector6&, const PolytopeIn<6>&, const RunContext*, Multipliers*);
template LinearBoundIn<Eigen::Dynamic> maximum(const Eigen::VectorXd&, const PolytopeIn<Eigen::Dynamic>&,
                                               const RunContext*, Multipliers*);

}  // namespace dismantle::immobility
