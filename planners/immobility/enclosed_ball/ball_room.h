/// Is a part shut in by others, whatever it does?
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

/// A large ball within a solid: its radius is at least 0.95 times the largest, within the budget. Branch and bound over
/// cubes: depths change no faster than the point moves.
Ball large_ball(const Solid& solid, std::uint64_t most_cubes = 2000);

/// A surface in the way, at `pose` (of the solid's frame), to which the ball's centre has to keep `distance` (> 0).
struct Wall {
  const Solid* solid;
  Pose pose;
  double distance;
};

struct Room {
  bool closed = false;
  double cell = 0;                  ///< closed: edge of the cells looked at, assembly units
  std::size_t cells = 0;            ///< ... and how many of them the centre may reach at most
  std::vector<std::size_t> bounds;  ///< ... walls that bound them, most often first
};

/// Can the centre get from `start` to the outside? Floods cells, of which none is left out where it may be. Cells too
/// coarse for that are halved a few times. Not closed when told to stop.
///
/// `closed` proves that it cannot. All the centre's places then lie in a bounded piece of the space that keeps its
/// distance to all walls. Such a piece lies in the convex hull of the walls: a point outside the hull could leave
/// straight away from it, and would come nearer to none of them.
Room room_of(const Eigen::Vector3d& start, const std::vector<Wall>& walls, std::size_t most_cells,
             const RunContext& context);
/// The same with cells of one edge; assembly units, > 0.
Room room_of_cells(const Eigen::Vector3d& start, const std::vector<Wall>& walls, double edge, std::size_t most_cells,
                   const RunContext& context);

}  // namespace dismantle::immobility
