#include "dismantle/free_space/body_points.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "dismantle/geometry/inner_ball.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::free_space {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr std::size_t kCandidates = 1000;  // triangles, from which the points are chosen
constexpr double kStiff = 1e-3;            // share of the largest moment: turns that move no point are not made

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

Twist closest_twist(const std::vector<Vec3>& points, const std::vector<Vec3>& wishes,
                    const std::vector<double>& weights, const Vec3& center) {
  double all = 0;
  Vec3 middle = Vec3::Zero(), way = Vec3::Zero();
  for (std::size_t k = 0; k < points.size(); ++k) {
    all += weights[k];
    middle += weights[k] * points[k];
    way += weights[k] * wishes[k];
  }
  middle /= all;
  way /= all;
  // About the middle of the points the two kinds of motion do not depend on each other.
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  Vec3 torque = Vec3::Zero();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3 arm = points[k] - middle;
    moments += weights[k] * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
    torque += weights[k] * arm.cross(wishes[k]);
  }
  Twist twist;
  const double stiff = kStiff * moments.trace();
  if (stiff > 0) twist.turn = (moments + stiff * Eigen::Matrix3d::Identity()).ldlt().solve(torque);
  twist.way = way + twist.turn.cross(center - middle);
  return twist;
}

}  // namespace dismantle::free_space
