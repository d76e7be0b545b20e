/// Rigid bodies that touch, with their weights: the input of all statics.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace dismantle::statics {

/// One rigid body. Any unit of length; the same one in the whole pile.
struct Body {
  double weight = 0;                                 ///< force of gravity, > 0 unless fixed
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< centre of mass
  double radius = 1;                                 ///< of a ball about `center` that holds the body; > 0
  bool fixed = false;                                ///< does not move: a support, a held part, the table
};

/// Two bodies touch in a plane, at the corners of the convex hull of the common region. Pressure over a region with
/// friction gives the same wrenches as forces at these corners.
struct Contact {
  std::uint32_t a = 0, b = 0;                         ///< indices of bodies
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit; out of b, into a
  std::vector<Eigen::Vector3d> points;
  double friction = 0;  ///< coefficient of Coulomb friction, >= 0
  bool bonded = false;  ///< carries any force: screwed, glued, pressed together
};

/// A force on a body, besides weights and contacts.
struct Push {
  std::uint32_t body = 0;
  Eigen::Vector3d at = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero();
};

/// What is judged.
struct Pile {
  std::vector<Body> bodies;
  std::vector<Contact> contacts;
  Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();  ///< unit
  std::vector<Push> pushes{};
};

/// Small rigid motion of a body: a point p moves by v + w x (p - center).
struct Motion {
  Eigen::Vector3d v = Eigen::Vector3d::Zero(), w = Eigen::Vector3d::Zero();
  Eigen::Vector3d at(const Eigen::Vector3d& offset) const { return v + w.cross(offset); }
};

/// Of all bodies; zero for those that are fixed.
using Motions = std::vector<Motion>;

/// Forces on body a of each contact, at its points; body b feels the opposite.
using ContactForces = std::vector<std::vector<Eigen::Vector3d>>;

}  // namespace dismantle::statics
