/// Random mazes for tests of push searches.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "maze.h"

namespace dismantle::push::test {

inline constexpr PartId kNear = 10, kFar = 11;

/// A random chain of tunnels with bends at right angles that never meet, and a dead end at every bend. The last tunnel
/// leads out. Gates block one of the first tunnels and one of the last.
struct RandomMaze {
  Maze maze;
  unsigned bends = 0;
};

inline RandomMaze random_maze(std::uint64_t seed) {
  Rng rng(seed);
  RandomMaze made;
  made.bends = 4 + static_cast<unsigned>(rng.below(4));
  Vector3d at = Vector3d::Zero();
  int axis = static_cast<int>(rng.below(3));
  std::vector<Aabb> tunnels;
  for (unsigned k = 0; k <= made.bends; ++k) {
    // Always towards positive coordinates: no tunnel comes near an earlier one.
    const Vector3d to =
        at + (k == made.bends ? 12.0 : 0.4 + 0.1 * static_cast<double>(rng.below(4))) * Vector3d::Unit(axis);
    tunnels.push_back(tunnel(at, to));
    const Vector3d middle = at + 0.6 * (to - at).normalized() * std::min(1.0, (to - at).norm() - 0.1) * 0.5;
    if (k == 1) made.maze.gates[kNear] = tunnel(middle, middle);
    if (k == made.bends - 1) made.maze.gates[kFar] = tunnel(middle, middle);
    axis = (axis + 1 + static_cast<int>(rng.below(2))) % 3;
    const Vector3d dead_end = to - 0.3 * Vector3d::Unit(axis);
    if (k < made.bends) tunnels.push_back(tunnel(to, dead_end));
    at = to;
  }
  made.maze.free = tunnels;
  return made;
}

}  // namespace dismantle::push::test
