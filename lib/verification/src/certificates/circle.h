/// Circles and straight lines that lie deep within a body.
#pragma once

#include "certificates/body.h"

namespace dismantle::certificates {

struct Circle {
  Vec3 center, axis;  ///< axis: unit
  double radius = 0;

  /// In the plane of the circle, from its centre.
  Vec3 direction(double angle) const;
  Vec3 point(double angle) const { return center + radius * direction(angle); }
};

/// From the numbers of a certificate; the radius is 0 where they make no circle.
Circle circle_of(const Certificate& certificate, const char* diameter);

/// Is all of the circle inside the body, and further than `depth` (>= 0) from its surface? One point of it is tested
/// for inside: where all of it keeps off the surface, all of it is on one side. The distance is bounded by dividing
/// arcs.
bool lies_deep(const Circle& circle, const Body& body, double depth);
/// The same of a straight line.
bool lies_deep(const Vec3& a, const Vec3& b, const Body& body, double depth);

}  // namespace dismantle::certificates
