/// Force of one contact point, a spring of unit stiffness, as a function of its displacement.
///
/// Each function returns the force on body a. `resistance`, if wanted, is minus its derivative by the displacement.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace dismantle::statics {

/// The projection of the elastic force on the friction cone. The resistance is symmetric and >= 0.
Eigen::Vector3d associated_force(const Eigen::Vector3d& moved, const Eigen::Vector3d& normal, double friction,
                                 Eigen::Matrix3d* resistance = nullptr);
/// Pressure of a spring that only pushes, and friction of at most `limit`. The resistance is symmetric and >= 0.
Eigen::Vector3d limited_force(const Eigen::Vector3d& moved, const Eigen::Vector3d& normal, double limit,
                              Eigen::Matrix3d* resistance = nullptr);
/// Coulomb's law: as limited_force() with the limit friction times pressure. The resistance is not symmetric.
Eigen::Vector3d coulomb_force(const Eigen::Vector3d& moved, const Eigen::Vector3d& normal, double friction,
                              Eigen::Matrix3d* resistance = nullptr);
/// A spring that pushes and pulls.
Eigen::Vector3d bonded_force(const Eigen::Vector3d& moved, Eigen::Matrix3d* resistance = nullptr);

}  // namespace dismantle::statics
