/// Distance through free space from any point between the fixed parts to the outside.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/free_space/parameters.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/simulator.h"

namespace dismantle::free_space {

/// A navigation function on a grid of cubic cells over the box of the fixed parts and a margin. A cell is free when no
/// surface passes through it and a small ball about its centre fits. Routes go from cell to neighbouring cell, keep
/// away from walls where there is room, and end at the boundary of the grid, which is outside. World frame, assembly
/// units.
class NavigationFunction {
 public:
  /// `ball`: radius of the ball that has to pass. It may exceed the clearance of a route by one cell.
  NavigationFunction(const Assembly& assembly, const std::vector<PlacedPart>& fixed, double ball,
                     const GridParameters& parameters);

  double cell() const { return cell_; }  ///< edge of a cell
  /// Length of the route to the outside; negative outside of the grid. A point that is not in a free cell with a route
  /// gets the length of the nearest such cell, plus GridParameters::blocked_length for each cell up to there.
  double remaining(const Eigen::Vector3d& p) const;
  /// Number of cells from the cell of `p` to the nearest one with a route; 0: the cell itself has one.
  unsigned cells_to_route(const Eigen::Vector3d& p) const;
  /// Centres of the cells along the route from the cell of `p`, that cell first. Empty: `p` is outside.
  std::vector<Eigen::Vector3d> route(const Eigen::Vector3d& p) const;
  /// A point on the route a few cells ahead, or outside; never `p` itself.
  Eigen::Vector3d lookahead(const Eigen::Vector3d& p) const;
  /// Blocks the narrowest place within the first `reach` of the route from `p`, and computes all routes again. For
  /// places where a ball passes but the body does not. False if there is no such place.
  bool close_narrowest(const Eigen::Vector3d& p, double reach);

 private:
  using Index = std::array<std::int32_t, 3>;

  void rasterize(const std::array<Eigen::Vector3d, 3>& corners);
  void compute_clearance();
  void compute_routes();
  void extend_into_walls();
  std::uint32_t cell_of(const Eigen::Vector3d& p) const;  ///< geometry::kNoIndex: outside
  std::uint32_t id(const Index& i) const;
  Eigen::Vector3d center(std::uint32_t cell) const;
  bool on_boundary(std::uint32_t cell) const;
  template <typename Visit>
  void for_each_neighbour(std::uint32_t cell, const Visit& visit) const;
  std::uint32_t lookahead_of(std::uint32_t cell) const;

  std::uint32_t wall_cost_;
  float blocked_length_;
  Aabb box_;
  double cell_ = 0;
  std::uint16_t min_clearance_ = 1;  // least clearance of a free cell, in thirds of a cell
  Index count_{};
  std::vector<std::uint16_t> clearance_;  // to the nearest cell with a surface, in thirds of a cell
  std::vector<std::uint32_t> cost_;       // of the route, in thirds of a cell that is far from walls
  std::vector<float> length_;             // of the route, in cells
  std::vector<std::uint32_t> next_;       // on the route; the cell itself at the boundary
  std::vector<std::uint8_t> cells_to_route_;
};

}  // namespace dismantle::free_space
