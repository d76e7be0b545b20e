/// Closed curves in which a plane cuts a surface.
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
  /// Where the plane cuts an edge that has one end above.
  Vec3 cut(const Vec3& a, const Vec3& b) const {
    const double ha = height(a), hb = height(b);
    return a + ha / (ha - hb) * (b - a);
  }
};

/// Across the edge from corner k of a triangle to the next one; kNone where the surface is open.
constexpr std::uint32_t kNone = 0xffffffffU;
using Neighbours = std::vector<std::array<std::uint32_t, 3>>;
Neighbours neighbours_of(const Body& body);

/// The k-th point is where the k-th triangle is entered, through the edge `edges[k]` (two vertices).
struct Loop {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> triangles;
  std::vector<std::array<std::uint32_t, 2>> edges;

  double diameter() const;  ///< the largest distance of two points
  /// How often the curve goes around the point, both seen along the plane's normal; with a sign.
  int turns(const Vec3& p, const Plane& plane) const;
  double distance(const Vec3& p) const;  ///< from the curve
};

/// Curves that are not closed are left out.
std::vector<Loop> section(const Body& body, const Neighbours& neighbours, const Plane& plane);

}  // namespace dismantle::certificates
