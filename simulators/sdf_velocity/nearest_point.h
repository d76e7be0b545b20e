/// Nearest point of a polyhedron to a given point: the quadratic program of a step.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace dismantle::sdf_velocity {

/// Minimises |y - target|^2 subject to normal_i . y >= offset_i for all i, with unit normals: dual active set method
/// (Goldfarb and Idnani, Mathematical Programming 27, 1983) for the unit matrix. Starts at the target and adds the most
/// violated constraint until none is violated. At most as many constraints as dimensions are active, so the cost
/// depends on the active constraints rather than on all. Ties go to the lower index: the same input gives the same
/// bits. Allocates only while it grows. A constraint is met if it is violated by at most geometry::kRounding (units of
/// y).
class NearestPoint {
 public:
  enum class Outcome {
    solved,
    infeasible,  ///< no point satisfies all constraints
    unfinished,  ///< stopped at the iteration limit; y is invalid
  };

  /// Removes all constraints; y has `dimensions` coordinates.
  void reset(Eigen::Index dimensions);
  /// Adds a constraint with zero normal and returns its index.
  Eigen::Index add();
  Eigen::Index count() const { return count_; }
  /// Normal of constraint i, which the caller must set to length 1.
  auto normal(Eigen::Index i) { return normals_.col(i); }
  double& offset(Eigen::Index i) { return offsets_[i]; }

  Outcome solve(const Eigen::VectorXd& target, Eigen::VectorXd& y);
  /// Active constraints of the last solve(), and their multipliers (> 0): y = target + sum force_k normal_k.
  const std::vector<Eigen::Index>& active() const { return active_; }
  const std::vector<double>& forces() const { return forces_; }
  int iterations() const { return iterations_; }

 private:
  void append(const Eigen::VectorXd& along, const Eigen::VectorXd& rest, double length);
  void drop(std::size_t k);

  Eigen::Index dimensions_ = 0, count_ = 0;
  Eigen::MatrixXd normals_;  ///< one column per constraint, plus unused columns
  Eigen::VectorXd offsets_;
  std::vector<Eigen::Index> active_;
  std::vector<double> forces_;
  Eigen::MatrixXd basis_, triangle_;  ///< orthonormal basis of the active normals, and their coordinates in it
  Eigen::VectorXd along_, rest_, change_, violation_;
  int iterations_ = 0;
};

}  // namespace dismantle::sdf_velocity
