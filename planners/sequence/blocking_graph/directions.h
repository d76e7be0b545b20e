/// Directions along which parts may leave in a straight line: what their surfaces suggest.
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
  std::vector<std::vector<std::size_t>> of_part;  ///< by part id: those worth trying for it, ascending
  std::vector<std::size_t> common;                ///< suggested by most surface, most first; both signs

  static std::size_t opposite(std::size_t d) { return d ^ 1U; }
};

/// Axes of `mesh`, signs left open, most surface first: normals of its flat faces, and the axis to which its surface is
/// most parallel (that of a pin, of a sleeve). At most `most` of the former.
std::vector<Eigen::Vector3d> axes_of(const Mesh& mesh, std::size_t most);

/// For each part its own axes, those of the assembly, and those that are most common among all parts.
Directions directions_of(const Assembly& assembly);

}  // namespace dismantle::blocking
