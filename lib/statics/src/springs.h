/// The convex program of balance(): elastic energy of all contact points, work of the load, and a proximal term.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "block_factor.h"
#include "contact_law.h"
#include "dismantle/statics/balance.h"

namespace dismantle::statics {

/// Weight of the proximal term at first, against the stiffness of a contact.
inline constexpr double kProximal = 1e-4;

/// Coordinates: six for each body that can move, scaled so that the proximal term is a multiple of the identity. The
/// total weight is 1.
class Springs {
 public:
  Springs(const Pile& pile, FrictionLaw law);

  /// Minimizes from the current point with the proximal term about `anchor`; false: Newton's method did not converge.
  bool minimize(const Eigen::VectorXd& anchor, const std::function<bool()>& stop);
  /// Begins at `x`; Coulomb: with the limits of friction of the pressure there.
  void start_at(const Eigen::VectorXd& x);
  /// Coulomb: with this many bodies, a pile gives way by more than a single contact does.
  bool is_long() const { return proximal_least_ < kProximal; }
  /// A smaller weight of the proximal term from now on.
  void lengthen_steps();
  /// A larger one. False: it is as large as it can be.
  bool shorten_steps();
  /// Coulomb: moves the limits of friction by a share of the way to those of the present pressure; returns the largest
  /// distance, as a share of the whole weight.
  double update_limits(double share = 1);
  /// Coulomb: Newton's method for the law itself, from the current point; the limits follow. False: not converged, and
  /// nothing changed.
  bool solve_coupled(const std::function<bool()>& stop);

  const Pile& pile() const { return pile_; }
  const Eigen::VectorXd& at() const { return x_; }
  /// Largest unbalanced share of a weight for the step from `anchor`.
  double residual(const Eigen::VectorXd& anchor) const;
  Motions motion_of(const Eigen::VectorXd& x) const;
  Eigen::VectorXd point_of(const Motions& motion) const;  ///< the inverse of motion_of()
  ContactForces forces() const;                           ///< in the units of the pile
  Eigen::Index size() const { return load_.size(); }
  unsigned factorizations() const { return factorizations_; }
  /// About how many multiplications were taken on this thread.
  static double work_done();

 private:
  struct Point {
    std::size_t contact, index;  // of the pile, and in the contact
    Eigen::Vector3d at, normal;  // from the origin of the pair
    double stiffness, friction, limit;
    bool bonded;
  };
  /// Two bodies that touch, at least one of which can move. Its points share blocks of the matrix.
  struct Pair {
    Eigen::Index a, b;             // first coordinate, -1: fixed
    std::size_t first, last;       // points
    Eigen::Vector3d arm_a, arm_b;  // from the centres to the origin
  };
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Block = BlockMatrix::Block;
  /// With a block for each pair whose two bodies can move: in the order of `pairs_`.
  BlockMatrix pattern() const;
  /// Of `hessian_`. False: it is singular.
  bool factorize(bool symmetric);
  /// How a moves against b, about the origin of the pair.
  Vec6 relative(const Pair& pair, const Eigen::VectorXd& x) const;
  static Eigen::Vector3d moved(const Point& p, const Vec6& u) { return u.head<3>() + u.tail<3>().cross(p.at); }
  Eigen::Vector3d law_of(const Point& p, const Eigen::Vector3d& moved, bool coupled = false,
                         Eigen::Matrix3d* resistance = nullptr) const;
  /// Adds a force with its torque on a, and the opposite on b, to generalized forces.
  void add_wrench(const Pair& pair, const Vec6& on_a, Eigen::VectorXd& forces) const;
  /// What Coulomb's law itself leaves unbalanced at the current point.
  Eigen::VectorXd unbalanced() const;
  /// About how far to go along a direction of descent: the slope there is a small share of that at the current point.
  double step_length(const Eigen::VectorXd& anchor, const Eigen::VectorXd& direction) const;
  /// The gradient, and the Hessian: without `ba`, or all of it if `coupled`, which takes Coulomb's law itself.
  Eigen::VectorXd derivatives(const Eigen::VectorXd& anchor, bool coupled);
  template <class Use>
  void each_point(const Eigen::VectorXd& x, const Use& use) const {
    for (const Pair& pair : pairs_) {
      const Vec6 u = relative(pair, x);
      for (std::size_t k = pair.first; k < pair.last; ++k) use(pair, k, moved(points_[k], u));
    }
  }

  const Pile& pile_;
  FrictionLaw law_;
  double unit_;                       // weight of everything that can move
  double proximal_, proximal_least_;  // weight of the proximal term
  std::vector<Eigen::Index> first_;
  std::vector<Pair> pairs_;
  std::vector<Point> points_;         // by pair
  Eigen::VectorXd load_, scale_, x_;  // true coordinate = scale * x
  std::vector<double> share_;         // weight of each body
  std::optional<BlockMatrix> hessian_;
  std::optional<BlockFactor> factor_;
  unsigned factorizations_ = 0;
};

}  // namespace dismantle::statics
