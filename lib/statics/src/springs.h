/// The convex program of balance(): elastic energy of all contact points, work of the load, and a proximal term.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <functional>
#include <vector>

#include "contact_law.h"
#include "dismantle/statics/balance.h"

namespace dismantle::statics {

/// Coordinates: six for each body that can move, scaled so that the proximal term is a multiple of the identity. The
/// total weight is 1.
class Springs {
 public:
  Springs(const Pile& pile, FrictionLaw law);

  /// Minimizes from the current point with the proximal term about `anchor`; false: Newton's method did not converge.
  bool minimize(const Eigen::VectorXd& anchor, const std::function<bool()>& stop);
  /// Coulomb: moves the limits of friction by a share of the way to those of the present pressure; returns the largest
  /// distance, as a share of the whole weight.
  double update_limits(double share = 1);
  /// Coulomb: Newton's method for the law itself, from the current point; the limits follow. False: not converged, and
  /// nothing changed.
  bool solve_coupled(const std::function<bool()>& stop);

  const Eigen::VectorXd& at() const { return x_; }
  /// Largest unbalanced share of a weight for the step from `anchor`.
  double residual(const Eigen::VectorXd& anchor) const;
  Motions motion_of(const Eigen::VectorXd& x) const;
  ContactForces forces() const;  ///< in the units of the pile
  Eigen::Index size() const { return load_.size(); }
  unsigned factorizations() const { return factorizations_; }

 private:
  struct Point {
    std::size_t contact;
    Eigen::Index a, b;  // first coordinate, -1: fixed
    Eigen::Vector3d ra, rb, normal;
    double stiffness, friction, limit;
    bool bonded;
  };
  Eigen::Vector3d moved(const Point& p, const Eigen::VectorXd& x) const;
  PointForce law_of(const Point& p, const Eigen::Vector3d& moved, bool coupled = false) const;
  /// What Coulomb's law itself leaves unbalanced at the current point.
  Eigen::VectorXd unbalanced() const;
  double value(const Eigen::VectorXd& x, const Eigen::VectorXd& anchor) const;
  /// The gradient, and the Hessian: its lower half, or all of it if `coupled`, which takes Coulomb's law itself.
  Eigen::VectorXd derivatives(const Eigen::VectorXd& anchor, bool coupled, Eigen::SparseMatrix<double>& hessian) const;

  const Pile& pile_;
  FrictionLaw law_;
  double unit_;  // weight of everything that can move
  std::vector<Eigen::Index> first_;
  std::vector<Point> points_;
  Eigen::VectorXd load_, scale_, x_;  // true coordinate = scale * x
  std::vector<double> share_;         // weight of each body
  bool analyzed_ = false, analyzed_coupled_ = false;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> coupled_;
  unsigned factorizations_ = 0;
};

}  // namespace dismantle::statics
