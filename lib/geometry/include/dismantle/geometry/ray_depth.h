/// Depths that a ray finds inside a solid.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "dismantle/geometry/ray.h"
#include "dismantle/geometry/solid.h"

namespace dismantle::geometry {

/// Calls `found` with the depth below the surface of a solid, and the distance along the ray, at some points where the
/// ray is inside the solid. All in the frame of the solid; `along`: unit.
template <class Found>
void depths_along(const Solid& solid, const Eigen::Vector3d& from, const Eigen::Vector3d& along, double reach,
                  const Found& found) {
  const auto enters = [&](std::uint32_t t) { return solid.normals[t].dot(along) < 0; };
  const auto leaves = [&](std::uint32_t t) { return solid.normals[t].dot(along) > 0; };
  double at = 0;
  bool inside = solid.box.squared_distance(from) == 0 && solid.bvh.inside(from);
  for (int ray = 0; ray < 4 && at < reach; ++ray) {  // few rays cross a part more often
    if (!inside) {
      const double in = first_hit(solid.bvh, from + at * along, along, reach - at, enters);
      if (!std::isfinite(in)) return;
      at += in;
    }
    const double out = std::min(reach - at, first_hit(solid.bvh, from + at * along, along, reach - at, leaves));
    for (const double share : {0.25, 0.5, 0.75}) {  // depth is largest away from both surfaces
      const double s = at + share * out;
      found(-solid.bvh.signed_distance(from + s * along), s);
    }
    at += out;
    inside = false;
  }
}

}  // namespace dismantle::geometry
