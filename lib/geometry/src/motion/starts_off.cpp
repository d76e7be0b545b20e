#include "dismantle/geometry/starts_off.h"

#include <algorithm>

#include "dismantle/geometry/numerics.h"

namespace dismantle::geometry {

bool starts_off(const Solid& b, const Solid& a, const Placement& to_a, double reach) {
  for (std::size_t k = 0; k + 1 < b.shell_begin.size(); ++k) {
    const std::uint32_t first = b.shell_begin[k], count = b.shell_begin[k + 1] - first;
    const std::uint32_t stride = std::max(1u, count / 64);  // about 64 vertices of each shell are tried
    bool found = false;
    for (std::uint32_t i = 0; i < count && !found; i += stride) {
      const Eigen::Vector3d x = to_a * b.mesh.vertices[b.shell_vertices[first + i]];
      found = a.box.squared_distance(x) > reach * reach ||
              (a.bvh.closest(x, reach).triangle == kNoIndex && !a.bvh.inside(x));
    }
    if (!found) return false;
  }
  return true;
}

}  // namespace dismantle::geometry
