/// What is left of a wanted displacement when nothing may be entered.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/sdf/contact_row.h"
#include "nearest_point.h"

namespace dismantle::sdf_velocity {

/// Of all displacements x of the bodies (see sdf::BodyWorld) the one nearest to `wanted`, in the norm that weighs
/// shifts with 1 and rotation vectors with the body's radius, under which each contact ends with
///   gap + J x >= 0.
/// Contacts that are below the surface already are to be lifted out of it, by `most_lift` at most; where that cannot be
/// done, for being squeezed from several sides, nothing gets deeper. So x = 0 is always possible at worst.
///
/// At a convex edge it is enough to be outside of one of the faces: each contact takes that which the wanted
/// displacement enters least, of those that it is outside of now, and takes others as long as that brings x nearer to
/// what is wanted. That ends in a local minimum of a problem that is not convex.
class ContactProjection {
 public:
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, sdf::kMaxDof, 1>;

  /// A face that a point is behind of by more than `behind` is not where it can pass an edge. `most_lift`: in one step.
  /// Assembly units.
  ContactProjection(double behind, double most_lift) : behind_(behind), most_lift_(most_lift) {}

  /// `radii`: one per body. `per_body`: 3 or 6.
  void project(const std::vector<sdf::ContactRow>& rows, int per_body, const std::vector<double>& radii,
               const Vector& wanted, Vector& x);

 private:
  enum class Below { lift, hold };  ///< what to do with contacts that are below the surface
  struct Group {
    std::size_t first = 0, count = 0, chosen = 0;
    double least = 0;  ///< faces with a smaller gap are not where the point can pass
  };

  void choose(const std::vector<sdf::ContactRow>& rows, int per_body, const Vector& x);
  bool exchange(const std::vector<sdf::ContactRow>& rows, int per_body, const Vector& x, std::size_t turn);
  bool solve(const std::vector<sdf::ContactRow>& rows, int per_body, Below below, const Vector& wanted, Vector& x);

  double behind_, most_lift_;
  NearestPoint nearest_;
  Vector scale_;  ///< per coordinate of x
  std::vector<Group> groups_;
  std::vector<Eigen::Index> holding_;  ///< groups that hold x
  double deepest_ = 0;
  Eigen::VectorXd target_, y_;
};

}  // namespace dismantle::sdf_velocity
