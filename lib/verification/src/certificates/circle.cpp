#include "certificates/circle.h"

#include <cmath>
#include <numbers>

#include "certificates/nearest.h"

namespace dismantle::certificates {
namespace {

/// True if the curve `at` does not meet the surface between two parameters. `speed`: bound of its derivative. `list`:
/// the triangles that may be nearest to one of its points.
template <class Curve>
bool keeps_off(const Curve& at, double speed, const NearestTriangles& surface, const NearestTriangles::List& list,
               double from, double to, int divisions) {
  const double reach = 0.5 * (to - from) * speed, middle = 0.5 * (from + to);
  NearestTriangles::List near;
  const double clearance = surface.clearance(at(middle), list, reach, near);
  if (clearance > reach) return true;
  if (!(clearance > 0) || divisions == 0) return false;
  return keeps_off(at, speed, surface, near, from, middle, divisions - 1) &&
         keeps_off(at, speed, surface, near, middle, to, divisions - 1);
}

template <class Curve>
bool curve_lies_deep(const Curve& at, double speed, double end, const Body& body, double depth) {
  if (!body.closed || !inside(at(0), body)) return false;
  NearestTriangles surface;
  surface.add(body, Pose{}, depth + rounding_of(body.box));
  // 18 divisions: pieces of a few millionths of the curve. A curve that near to the limit is refused.
  return keeps_off(at, speed, surface, surface.all(), 0, end, 18);
}

}  // namespace

Vec3 Circle::direction(double angle) const {
  const Vec3 e = axis.unitOrthogonal();
  return std::cos(angle) * e + std::sin(angle) * axis.cross(e);
}

Circle circle_of(const Certificate& certificate, const char* diameter) {
  const auto vector = [&](const char* name) {
    const auto& n = certificate.numbers.at(name);
    return Vec3(n[0], n[1], n[2]);
  };
  Circle circle{vector("center"), vector("axis"), 0.5 * certificate.numbers.at(diameter).front()};
  if (!(std::abs(circle.axis.norm() - 1) < 1e-9) || !(circle.radius > 0)) circle.radius = 0;
  circle.axis.normalize();
  return circle;
}

bool lies_deep(const Circle& circle, const Body& body, double depth) {
  return curve_lies_deep([&](double angle) { return circle.point(angle); }, circle.radius, 2 * std::numbers::pi, body,
                         depth);
}

bool lies_deep(const Vec3& a, const Vec3& b, const Body& body, double depth) {
  return curve_lies_deep([&](double t) { return Vec3(a + t * (b - a)); }, (b - a).norm(), 1, body, depth);
}

}  // namespace dismantle::certificates
