/// Actions of the search: the paper's unit actions, and directions that the contacts propose.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/push_search/frame.h"
#include "dismantle/push_search/tactics.h"
#include "dismantle/simulator.h"

namespace dismantle::push {

/// Section 4.2: forces along the axes (columns, orthonormal) in both directions; with `turns` also torques about them.
/// Each action is the same for all bodies.
std::vector<Action> unit_actions(const World& world, double force, bool turns,
                                 const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());
/// Forces along the 8 space and 12 plane diagonals of the axes.
std::vector<Action> diagonal_actions(const World& world, double force,
                                     const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());
/// Torques about the axes in both directions, each combined with a force along the same axis in both directions.
std::vector<Action> screw_actions(const World& world, double force,
                                  const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());
/// For parts that move independently: one part is pushed along an axis or (`turns`) turned about it, in both
/// directions. The others have no wrench; only contact moves them.
std::vector<Action> one_driven(const World& world, double force, bool turns, const Eigen::Matrix3d& axes);
/// The same for two parts that are driven simultaneously, along the same axis or (`across`) along different ones. The
/// others have no wrench.
std::vector<Action> two_driven(const World& world, double force, bool turns, const Eigen::Matrix3d& axes, bool across);
/// A force along `direction` (of any length) on every moving part.
Action push(const World& world, double force, const Eigen::Vector3d& direction);

/// Translations by which the moving parts, as one body, can slide away from their contacts, to first order.
struct Freedom {
  std::vector<Eigen::Vector3d> normals;     ///< distinct normals of the contacts, the most frequent first
  std::vector<Eigen::Vector3d> directions;  ///< unit; none points into a contact. The shortest way out first
};

/// The directions are the normals and the lines along which two contacts slide, unless another contact blocks them:
/// extreme rays of the cone of feasible translations. They are few and rotate with the assembly.
Freedom freedom_of(const std::vector<Contact>& contacts, const std::vector<PlacedPart>& moving, const Extents& extents,
                   const ProposalParameters& parameters);
/// Free directions combined with pressure against a wall along them, to find an opening in that wall.
std::vector<Eigen::Vector3d> leaning(const Freedom& freedom, double lean);

}  // namespace dismantle::push
