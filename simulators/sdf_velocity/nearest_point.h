/// The point of a polyhedron that is nearest to a given one: the quadratic program of a step.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace dismantle::sdf_velocity {

/// Minimises |y - target|^2 subject to normal_i . y >= offset_i for all i, with unit normals: dual active set method
/// (Goldfarb and Idnani, Mathematical Programming 27, 1983) for the unit matrix. Begins at the target and takes in the
/// constraint violated most until none is; holds at most as many as there are dimensions, so that what counts is how
/// many constraints hold the solution, not how many there are. Ties go to the lower index: the same input gives the
/// same bits. Allocates only while it grows.
/// A constraint is met when it is violated by no more than geometry::kRounding (units of y).
class NearestPoint {
 public:
  enum class Outcome {
    solved,
    infeasible,  ///< no point satisfies all constraints
    unfinished,  ///< gave up; y means nothing
  };

  /// Forgets all constraints; y has `dimensions` coordinates.
  void reset(Eigen::Index dimensions);
  /// Adds a constraint with zero normal and returns its index.
  Eigen::Index add();
  Eigen::Index count() const { return count_; }
  /// Normal of constraint i. The caller keeps its length at 1.
  auto normal(Eigen::Index i) { return normals_.col(i); }
  double& offset(Eigen::Index i) { return offsets_[i]; }

  Outcome solve(const Eigen::VectorXd& target, Eigen::VectorXd& y);
  /// Of the last solve(): the constraints that hold y, and how hard (> 0): y = target + sum force_k normal_k.
  const std::vector<Eigen::Index>& active() const { return active_; }
  const std::vector<double>& forces() const { return forces_; }
  int iterations() const { return iterations_; }

 private:
  void append(const Eigen::VectorXd& along, const Eigen::VectorXd& rest, double length);
  void drop(std::size_t k);

  Eigen::Index dimensions_ = 0, count_ = 0;
  Eigen::MatrixXd normals_;  ///< one column each; more columns than are in use
  Eigen::VectorXd offsets_;
  std::vector<Eigen::Index> active_;
  std::vector<double> forces_;
  Eigen::MatrixXd basis_, triangle_;  ///< orthonormal basis of the active normals, and their coordinates in it
  Eigen::VectorXd along_, rest_, change_, violation_;
  int iterations_ = 0;
};

}  // namespace dismantle::sdf_velocity
