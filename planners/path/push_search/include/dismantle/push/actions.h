/// What the search pushes and turns with: the paper's unit actions, and directions that the contacts propose.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/push/frame.h"
#include "dismantle/push/tactics.h"
#include "dismantle/simulator.h"

namespace dismantle::push {

/// Section 4.2: a force along each of the axes (columns, orthonormal), both ways; with `turns` also a torque about
/// each. The same for all bodies.
std::vector<Action> unit_actions(const World& world, double force, bool turns,
                                 const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());
/// Forces along the 8 space and 12 plane diagonals of the axes.
std::vector<Action> diagonal_actions(const World& world, double force,
                                     const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());
/// A torque about each axis, both ways, together with a force along the same axis, both ways: turn and pull.
std::vector<Action> screw_actions(const World& world, double force,
                                  const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());
/// For parts that move each in its own way: one is pushed along an axis or (`turns`) turned about it, both ways; the
/// others are free, and go where they are pushed by contact.
std::vector<Action> one_driven(const World& world, double force, bool turns, const Eigen::Matrix3d& axes);
/// The same for two parts that are driven simultaneously, along the same axis or (`across`) along different ones. The
/// rest are free.
std::vector<Action> two_driven(const World& world, double force, bool turns, const Eigen::Matrix3d& axes, bool across);
/// A force along `direction` (need not be unit) on every moving part.
Action push(const World& world, double force, const Eigen::Vector3d& direction);

/// How the moving parts, taken as one, can slide away from where they touch: first order, translations only.
struct Freedom {
  std::vector<Eigen::Vector3d> normals;     ///< distinct normals of the contacts, the most frequent first
  std::vector<Eigen::Vector3d> directions;  ///< unit; lead into no contact. The shortest way out first
};

/// Directions are the normals themselves and the lines along which two contacts slide, as far as all other contacts
/// let them: extreme rays of the cone of feasible translations. Few, and they turn with the assembly.
Freedom freedom_of(const std::vector<Contact>& contacts, const std::vector<PlacedPart>& moving, const Extents& extents,
                   const ProposalParameters& parameters);
/// Slide along a free direction and lean on a wall: the way to find an opening in it.
std::vector<Eigen::Vector3d> leaning(const Freedom& freedom, double lean);

}  // namespace dismantle::push
