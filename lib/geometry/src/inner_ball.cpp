#include "dismantle/geometry/inner_ball.h"

namespace dismantle {

double inner_ball_radius(const TriangleBvh& surface, const Eigen::Vector3d& p, const Eigen::Vector3d& inward,
                         double most) {
  double radius = most;
  for (int k = 0; k < 30; ++k) {  // converges in a few steps; slivers make it slow
    const ClosestPoint seen = surface.closest(p + radius * inward, radius * (1 - 1e-9));
    if (!(seen.distance < radius - 1e-7 * most)) break;  // the ball touches a second point of the surface
    const Eigen::Vector3d to = seen.point - p;
    const double along = to.dot(inward);
    if (!(along > 0)) return 0;
    const double next = to.squaredNorm() / (2 * along);
    if (!(next < radius)) break;
    radius = next;
  }
  return radius;
}

}  // namespace dismantle
