/// Circles and straight lines that lie deep within a body.
#pragma once

#include "certificates/body.h"

namespace dismantle::certificates {

struct Circle {
  Vec3 center, axis;  ///< axis: unit
  double radius = 0;

  /// Unit vector in the plane of the circle, from its centre.
  Vec3 direction(double angle) const;
  Vec3 point(double angle) const { return center + radius * direction(angle); }
};

/// Reads the circle from the numbers of a certificate; radius 0 if they are not a valid circle.
Circle circle_of(const Certificate& certificate, const char* diameter);

/// True if the whole circle is inside the body, more than `depth` (>= 0) from its surface. Dividing arcs bounds the
/// distance. One point is tested for inside, since a circle that nowhere meets the surface is on one side of it.
bool lies_deep(const Circle& circle, const Body& body, double depth);
/// The same for a segment.
bool lies_deep(const Vec3& a, const Vec3& b, const Body& body, double depth);

}  // namespace dismantle::certificates
