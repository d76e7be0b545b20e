#include "dismantle/geometry/inner_ball.h"

namespace dismantle {
double inner_ball_radius(const TriangleBvh& surface, const Eigen::Vector3d& p, const Eigen::Vector3d& inward,
                         double most) {
  double radius = most;
  for (int k = 0; k < 30; ++k) {  // converges in about ten rounds; this is the upper limit
    // A surface point that is nearer than the radius by less than this share counts as touched.
    const ClosestPoint seen = surface.closest(p + radius * inward, radius * (1 - 1e-7));
    if (!(seen.distance < radius)) break;
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
