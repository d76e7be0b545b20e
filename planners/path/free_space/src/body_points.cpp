#include "dismantle/free_space/body_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "dismantle/geometry/inner_ball.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::free_space {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr std::size_t kCandidates = 1000;  // triangles, from which the points are chosen

}  // namespace

std::vector<BodyPoint> body_points(const Mesh& mesh, std::size_t most) {
  std::vector<BodyPoint> points;
  std::vector<Vec3> surface, inward;
  const std::size_t every = mesh.triangles.size() / kCandidates + 1;
  for (std::size_t k = 0; k < mesh.triangles.size(); k += every) {
    const Triangle& t = mesh.triangles[k];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 n = (b - a).cross(c - a);
    if (!(n.norm() > 0)) continue;
    // One would do for small triangles, but there are few of the large ones, and they reach far.
    for (const Vec3& p : {a, b, c}) {
      surface.emplace_back((4 * p + (a + b + c)) / 7);
      inward.push_back(-n.normalized());
    }
  }
  if (surface.empty()) return points;
  const TriangleBvh bvh(mesh);
  const double size = mesh.box().size().norm();
  std::vector<double> away(surface.size(), std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  for (std::size_t k = 0; k < surface.size(); ++k)
    if ((surface[k] - mesh.box().center()).norm() > (surface[next] - mesh.box().center()).norm()) next = k;
  while (points.size() < most && away[next] > 1e-9) {
    BodyPoint point;
    point.radius = inner_ball_radius(bvh, surface[next], inward[next], size);
    point.center = surface[next] + point.radius * inward[next];
    points.push_back(point);
    const Vec3 taken = surface[next];
    for (std::size_t k = 0; k < surface.size(); ++k) away[k] = std::min(away[k], (surface[k] - taken).norm());
    next = static_cast<std::size_t>(std::max_element(away.begin(), away.end()) - away.begin());
  }
  return points;
}

}  // namespace dismantle::free_space
