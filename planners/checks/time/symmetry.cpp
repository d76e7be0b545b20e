#include "symmetry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <numbers>
#include <vector>

#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::checks {

namespace {

using Eigen::Vector3d;

constexpr double kSame = 0.01;  // of the diagonal of the box
constexpr std::size_t kMostPoints = 200;
constexpr double kAnyTurn[] = {1.0, 0.37};  // rad; no regular shape is the same after both
constexpr int kAxes = 12;                   // axes across, from a feature on

}  // namespace

Symmetry symmetry_of(const Mesh& mesh, const Vector3d& axis) {
  const TriangleBvh surface(mesh);
  Vector3d middle = Vector3d::Zero(), widest = Vector3d::Zero();
  double area = 0, largest = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d normal = (mesh.vertex(t, 1) - mesh.vertex(t, 0)).cross(mesh.vertex(t, 2) - mesh.vertex(t, 0));
    area += normal.norm();
    middle += normal.norm() * (mesh.vertex(t, 0) + mesh.vertex(t, 1) + mesh.vertex(t, 2)) / 3;
    const Vector3d across = normal - normal.dot(axis) * axis;
    if (across.norm() > largest) {
      largest = across.norm();
      widest = across / largest;
    }
  }
  if (!(area > 0) || widest.isZero()) return {};
  middle /= area;
  const double tolerance = kSame * mesh.box().size().norm();
  const std::size_t stride = 1 + mesh.vertices.size() / kMostPoints;
  const auto same = [&](double angle, const Vector3d& about) {
    const Eigen::AngleAxisd turn(angle, about);
    for (std::size_t v = 0; v < mesh.vertices.size(); v += stride)
      if (surface.closest(middle + turn * (mesh.vertices[v] - middle), tolerance).distance > tolerance) return false;
    return true;
  };
  Symmetry found;
  if (same(kAnyTurn[0], axis) && same(kAnyTurn[1], axis)) found.beta = 0;
  for (const int n : {8, 6, 5, 4, 3, 2})
    if (found.beta == 360 && same(2 * std::numbers::pi / n, axis)) found.beta = 360.0 / n;
  if (found.beta == 0 && same(kAnyTurn[0], widest) && same(kAnyTurn[1], widest)) return {0, 0};
  for (int k = 0; k < kAxes && found.alpha == 360; ++k)
    if (same(std::numbers::pi, Eigen::AngleAxisd(k * std::numbers::pi / kAxes, axis) * widest)) found.alpha = 180;
  return found;
}

}  // namespace dismantle::checks
