#include "turned_first.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "dismantle/geometry/face_axes.h"

namespace dismantle::checks {
namespace {

/// True if points at the largest distance from the axis are all around it.
bool is_round(const Mesh& mesh, const TurningAxis& axis) {
  const Eigen::Vector3d u = axis.direction.unitOrthogonal(), v = axis.direction.cross(u);
  double largest = 0;
  for (const Eigen::Vector3d& p : mesh.vertices)
    largest = std::max(largest, (p - axis.point).cross(axis.direction).norm());
  std::vector<double> angles;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    const Eigen::Vector3d from = p - axis.point;
    if (from.cross(axis.direction).norm() > 0.99 * largest) angles.push_back(std::atan2(v.dot(from), u.dot(from)));
  }
  if (angles.empty()) return false;
  std::sort(angles.begin(), angles.end());
  double gap = angles.front() + 2 * std::numbers::pi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
  return gap < std::numbers::pi / 5;
}

}  // namespace

std::optional<TurningAxis> turning_axis(const Mesh& mesh) {
  std::vector<geometry::FaceAxis> faces;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d normal = geometry::area_vector(mesh, t);
    if (const double size = normal.norm(); size > 0) faces.push_back({normal / size, size});
  }
  auto axes = geometry::rounded_axes(faces);
  geometry::sort_by_area(axes, 1);
  for (std::size_t i = 0; i < std::min<std::size_t>(axes.size(), 3); ++i) {
    TurningAxis out{Eigen::Vector3d::Zero(), axes[i].axis.normalized()};
    const Eigen::Vector3d u = out.direction.unitOrthogonal(), v = out.direction.cross(u);
    Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), most = -least;
    for (const Eigen::Vector3d& p : mesh.vertices) {
      least = least.cwiseMin(Eigen::Vector2d(u.dot(p), v.dot(p)));
      most = most.cwiseMax(Eigen::Vector2d(u.dot(p), v.dot(p)));
    }
    const Eigen::Vector2d middle = (least + most) / 2;
    out.point = middle.x() * u + middle.y() * v;
    if (is_round(mesh, out)) return out;
  }
  return std::nullopt;
}

Pose turned_about(const TurningAxis& axis, double angle) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, axis.direction));
  return {axis.point - turn * axis.point, turn};
}

}  // namespace dismantle::checks
