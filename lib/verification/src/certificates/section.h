/// Closed curves where a plane cuts a surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "certificates/body.h"

namespace dismantle::certificates {

struct Plane {
  Vec3 normal;  ///< unit
  double offset = 0;
  double height(const Vec3& p) const { return normal.dot(p) - offset; }
  bool above(const Vec3& p) const { return height(p) > 0; }  ///< a point in the plane counts as below it
  /// Intersection with an edge whose ends are on different sides.
  Vec3 cut(const Vec3& a, const Vec3& b) const {
    const double ha = height(a), hb = height(b);
    return a + ha / (ha - hb) * (b - a);
  }
};

/// [t][k]: triangle across the edge from corner k of triangle t to the next corner; kNone: the surface is open.
constexpr std::uint32_t kNone = 0xffffffffU;
using Neighbours = std::vector<std::array<std::uint32_t, 3>>;
Neighbours neighbours_of(const Body& body);

/// The curve enters triangles[k] at points[k], through the edge `edges[k]` (two vertices).
struct Loop {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> triangles;
  std::vector<std::array<std::uint32_t, 2>> edges;

  double diameter() const;  ///< the largest distance of two points
  /// Signed winding number about the point, both projected along the plane's normal.
  int turns(const Vec3& p, const Plane& plane) const;
  double distance(const Vec3& p) const;  ///< from the curve
};

/// Curves that are not closed are left out.
std::vector<Loop> section(const Body& body, const Neighbours& neighbours, const Plane& plane);

}  // namespace dismantle::certificates
