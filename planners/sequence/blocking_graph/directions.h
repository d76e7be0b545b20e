/// Candidate directions of straight removals, from the surfaces of the parts.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <vector>

#include "dismantle/assembly.h"

namespace dismantle::blocking {

/// Unit vectors, all different, in pairs: direction k ^ 1 is opposite to k.
struct Directions {
  std::vector<Eigen::Vector3d> all;
  std::vector<std::vector<std::size_t>> of_part;  ///< by part id: its candidates, ascending
  std::vector<std::size_t> common;                ///< those with the most surface area, largest first; both signs

  static std::size_t opposite(std::size_t d) { return d ^ 1U; }
};

/// Axes of `mesh`, of arbitrary sign, largest surface area first: at most `most` normals of flat faces, and the axis to
/// which the surface is most parallel (the axis of a pin or a sleeve).
std::vector<Eigen::Vector3d> axes_of(const Mesh& mesh, std::size_t most);

/// For each part its own axes, the coordinate axes, and the axes with the most surface area of all parts.
Directions directions_of(const Assembly& assembly);

}  // namespace dismantle::blocking
