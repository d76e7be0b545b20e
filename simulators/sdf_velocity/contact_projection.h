/// Projection of a wanted displacement on the displacements without penetration.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/sdf/contact_row.h"
#include "nearest_point.h"

namespace dismantle::sdf_velocity {

/// Finds the displacement x of the bodies (see sdf::BodyWorld) nearest to `wanted`, in the norm with weight 1 for
/// shifts and the body's radius for rotation vectors, subject to, for each contact,
///   gap + J x >= 0.
/// Contacts already below the surface are lifted out of it, by at most `most_lift`. If that is impossible because a
/// body is blocked from several sides, no contact gets deeper. So x = 0 is always feasible.
///
/// At a convex edge a point must be outside only one of the faces. Each contact starts with the face that the wanted
/// displacement enters least, of those that it is outside of now, and exchanges it as long as x gets nearer to
/// `wanted`. The result is a local minimum of a nonconvex problem.
class ContactProjection {
 public:
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, sdf::kMaxDof, 1>;

  /// A point that is behind a face by more than `behind` cannot pass the edge at that face. `most_lift`: per step.
  /// Assembly units.
  ContactProjection(double behind, double most_lift) : behind_(behind), most_lift_(most_lift) {}

  /// `radii`: one per body. `per_body`: 3 or 6.
  void project(const std::vector<sdf::ContactRow>& rows, int per_body, const std::vector<double>& radii,
               const Vector& wanted, Vector& x);

 private:
  enum class Below { lift, hold };  ///< treatment of contacts below the surface
  struct Group {
    std::size_t first = 0, count = 0, chosen = 0;
    double least = 0;  ///< the point cannot pass at faces with a smaller gap
  };

  void choose(const std::vector<sdf::ContactRow>& rows, int per_body, const Vector& x);
  bool exchange(const std::vector<sdf::ContactRow>& rows, int per_body, const Vector& x, std::size_t turn);
  bool solve(const std::vector<sdf::ContactRow>& rows, int per_body, Below below, const Vector& wanted, Vector& x);

  double behind_, most_lift_;
  NearestPoint nearest_;
  Vector scale_;  ///< per coordinate of x
  std::vector<Group> groups_;
  std::vector<Eigen::Index> holding_;  ///< groups that constrain x
  double deepest_ = 0;
  Eigen::VectorXd target_, y_;
};

}  // namespace dismantle::sdf_velocity
