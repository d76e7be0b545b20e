/// Signed distance field on a regular grid (appendix A).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/sdf/surface_query.h"

namespace dismantle::sdf {

struct GridOptions {
  double cell = 0.05;                   ///< appendix A: largest cell edge, assembly units, > 0
  int cells_per_edge = 20;              ///< appendix A: cell <= L_i / cells_per_edge along each axis, >= 1
  std::int64_t max_nodes = 30'000'000;  ///< if exceeded, cells grow evenly on all axes
  bool exact = false;                   ///< exact distances at all nodes: for coarse grids that bound distances
};

/// Coarse grid for users that query the triangles near the surface: it bounds the distance. It has a hundredth of the
/// nodes of the default grid and equally good bounds, since all its nodes are exact.
constexpr GridOptions bounding_grid() { return {.cell = 0.25, .cells_per_edge = 6, .exact = true}; }

/// Distance at grid nodes: exact to float precision in a band around the surface, with eight fast sweeps of the Eikonal
/// equation (Zhao 2005) elsewhere; or exact everywhere. Trilinear between nodes.
///
/// Error: at nodes of the band none; between nodes at most half the cell's diagonal (0.87 of its edge) anywhere and about
/// curvature * cell^2 / 8 where the surface is smooth; far nodes have the error of the first-order scheme (a few per
/// cent, covered by lower_bound()). Outside the grid the value is extended by the distance to the grid.
class DistanceGrid {
 public:
  DistanceGrid(const Solid& solid, const SurfaceQuery& surface, const GridOptions& options);

  double value(const Eigen::Vector3d& p) const;
  /// Value and normalised gradient of the trilinear interpolant; the gradient is zero only where degenerate.
  double value(const Eigen::Vector3d& p, Eigen::Vector3d& gradient) const;
  /// Lower bound of the true distance for any p: radius of a sphere around p that contains no surface. 0 near the
  /// surface or inside.
  double lower_bound(const Eigen::Vector3d& p) const;
  /// Error bound of value() where its magnitude is below a cell's diagonal; everywhere if all nodes are exact.
  double error_near() const { return 0.5 * cell_.norm() + rounding_; }

  const Eigen::Vector3d& cell() const { return cell_; }
  const Eigen::Vector3d& origin() const { return origin_; }
  const Eigen::Array3i& nodes() const { return nodes_; }
  double band() const { return band_; }  ///< nodes nearer than this hold exact distances
  std::size_t bytes() const { return values_.size() * sizeof(float); }
  float node(int i, int j, int k) const { return values_[index(i, j, k)]; }

 private:
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(nodes_.y()) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(nodes_.x()) +
           static_cast<std::size_t>(i);
  }
  struct Place {
    std::size_t first;     ///< node with the least indices
    Eigen::Array3d share;  ///< position in the cell from there, [0, 1]
  };
  Place locate(const Eigen::Vector3d& p) const;
  double interpolate(const Place& place, Eigen::Vector3d* gradient) const;
  void fill_band(const Solid& solid, const SurfaceQuery& surface);
  void propagate_signs();
  void sweep();
  void fill(const SurfaceQuery& surface);

  Eigen::Vector3d origin_, cell_, inverse_cell_;
  Eigen::Array3i nodes_;
  Eigen::Array3d last_;  ///< node, along each axis
  Aabb box_;             ///< from the first node to the last
  double band_ = 0;
  double rounding_ = 0;  ///< rounding of distances in the grid, stored as float
  bool exact_everywhere_ = false;
  std::vector<float> values_;
  std::vector<std::uint8_t> exact_;  // only while building
};

}  // namespace dismantle::sdf
