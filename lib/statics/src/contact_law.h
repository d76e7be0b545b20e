/// Force of one contact point as a function of its displacement, with derivative and energy.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace dismantle::statics {

/// Spring of unit stiffness.
struct PointForce {
  Eigen::Vector3d force;  ///< on body a
  Eigen::Matrix3d
      resistance;  ///< minus its derivative by the displacement; symmetric and >= 0 where there is an energy
  double energy;
};

/// The projection of the elastic force on the friction cone.
PointForce associated_force(const Eigen::Vector3d& moved, const Eigen::Vector3d& normal, double friction);
/// Pressure of a spring that only pushes, and friction of at most `limit`.
PointForce limited_force(const Eigen::Vector3d& moved, const Eigen::Vector3d& normal, double limit);
/// Coulomb's law: as limited_force() with the limit friction times pressure. Not symmetric, no energy.
PointForce coulomb_force(const Eigen::Vector3d& moved, const Eigen::Vector3d& normal, double friction);
/// A spring that pushes and pulls.
PointForce bonded_force(const Eigen::Vector3d& moved);

}  // namespace dismantle::statics
