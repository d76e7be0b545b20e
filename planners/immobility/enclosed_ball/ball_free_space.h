/// The free space of a ball between walls: a flood fill of cells.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/pose.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

struct Ball {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< frame of the solid
  double radius = 0;                                 ///< 0: none found
};

/// A large ball within a solid, by branch and bound over cubes: the depth of a point changes no faster than the point
/// moves. Its radius is at least 0.95 times the largest if `most_cubes` divisions suffice.
Ball inscribed_ball(const Solid& solid, std::uint64_t most_cubes = 2000);

/// An obstacle at `pose` (of the solid's frame), from which the ball's centre must keep `distance` (> 0).
struct Wall {
  const Solid* solid;
  Pose pose;
  double distance;
};

struct FreeSpace {
  bool closed = false;
  double cell = 0;                  ///< closed: edge of the cells, assembly units
  std::size_t cells = 0;            ///< closed: number of cells that the centre may be in
  std::vector<std::size_t> bounds;  ///< closed: walls that bound them, the one that bounds most cells first
};

/// Tests whether the centre can get from `start` to the outside. Fills cells, including every cell that contains a free
/// position. If they lead outside, repeats with half the edge, a few times. Not closed when told to stop, or with more
/// than `most_cells` cells.
///
/// `closed` proves that it cannot. All positions that the centre can reach are then in a bounded component of the free
/// space. Such a component is in the convex hull of the walls: from a point outside the hull the centre could move
/// straight away from it without coming nearer to any wall.
FreeSpace flood_free_space(const Eigen::Vector3d& start, const std::vector<Wall>& walls, std::size_t most_cells,
                           const RunContext& context);
/// As flood_free_space(), with cells of one edge only; assembly units, > 0.
FreeSpace flood_with_cells(const Eigen::Vector3d& start, const std::vector<Wall>& walls, double edge,
                           std::size_t most_cells, const RunContext& context);

}  // namespace dismantle::immobility
