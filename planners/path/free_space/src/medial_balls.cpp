#include "dismantle/free_space/medial_balls.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "dismantle/geometry/inner_ball.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::free_space {
namespace {

using Vec3 = Eigen::Vector3d;

}  // namespace

std::vector<MedialBall> medial_balls(const Mesh& mesh, std::size_t max_count) {
  std::vector<MedialBall> balls;
  std::vector<Vec3> surface, inward;
  // About 1000 triangles are enough to choose from, so a finer mesh does not cost more.
  const std::size_t stride = mesh.triangles.size() / 1000 + 1;
  for (std::size_t k = 0; k < mesh.triangles.size(); k += stride) {
    const Triangle& t = mesh.triangles[k];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 n = (b - a).cross(c - a);
    if (!(n.norm() > 0)) continue;
    // A large triangle reaches far, so each one has three samples, each near one of its corners.
    for (const Vec3& p : {a, b, c}) {
      surface.emplace_back((4 * p + (a + b + c)) / 7);
      inward.push_back(-n.normalized());
    }
  }
  if (surface.empty()) return balls;
  const TriangleBvh bvh(mesh);
  const double size = mesh.box().size().norm();
  std::vector<double> distance_to_chosen(surface.size(), std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  for (std::size_t k = 0; k < surface.size(); ++k)
    if ((surface[k] - mesh.box().center()).norm() > (surface[next] - mesh.box().center()).norm()) next = k;
  while (balls.size() < max_count && distance_to_chosen[next] > 1e-9) {  // samples that coincide are chosen once
    MedialBall ball;
    ball.radius = inner_ball_radius(bvh, surface[next], inward[next], size);
    ball.center = surface[next] + ball.radius * inward[next];
    balls.push_back(ball);
    const Vec3 chosen = surface[next];
    for (std::size_t k = 0; k < surface.size(); ++k)
      distance_to_chosen[k] = std::min(distance_to_chosen[k], (surface[k] - chosen).norm());
    next = static_cast<std::size_t>(std::max_element(distance_to_chosen.begin(), distance_to_chosen.end()) -
                                    distance_to_chosen.begin());
  }
  return balls;
}

}  // namespace dismantle::free_space
