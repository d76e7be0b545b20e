/// The grid on which the pieces of an interlocking puzzle or burr lie.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "dismantle/mesh.h"

namespace dismantle::lattice {

/// A grid of boxes. Most flat faces of the parts lie in its planes, or each a little behind its plane, so that parts
/// have play.
struct Lattice {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< rows: unit vectors, orthogonal, right-handed
  Eigen::Vector3d pitch = Eigen::Vector3d::Ones();     ///< edges of a cell, assembly units
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();    ///< corner of cell (0, 0, 0), along the axes

  /// Grid coordinates: cell c is the box from c to c + 1.
  Eigen::Vector3d to_grid(const Eigen::Vector3d& p) const { return (axes * p - origin).cwiseQuotient(pitch); }
  /// A translation by `steps` cells, in assembly units.
  Eigen::Vector3d translation(const Eigen::Vector3d& steps) const {
    return axes.transpose() * steps.cwiseProduct(pitch);
  }
};

/// Longest side of an assembly, in cells: a finer grid is not looked for.
inline constexpr int kMostCells = 48;

/// The coarsest grid that nearly all flat faces across three orthogonal axes fit. `tolerance`: of the verifier. None:
/// there is no such grid, less than half of its planes have faces, or the play is too large for it. Faces in other
/// directions do not matter, as long as they are less than two thirds of the surface.
std::optional<Lattice> lattice_of(const std::vector<const Mesh*>& meshes, double tolerance);

using Cell = std::array<int, 3>;

/// The cells of a part, ascending. A cell counts if its middle is inside, or if `touched` and the surface passes
/// through the box that is left when each side of the cell is moved inwards by `inset` (share of its edge, < 0.5).
std::vector<Cell> cells_of(const Mesh& mesh, const Lattice& lattice, const Eigen::Vector3d& inset, bool touched);

/// Those cells whose middle is inside, and whose box with this inset the surface does not enter.
std::vector<Cell> full_cells_of(const Mesh& mesh, const Lattice& lattice, const Eigen::Vector3d& inset);

}  // namespace dismantle::lattice
