#include "dismantle/sdf/triangle_slabs.h"

#include <Eigen/Geometry>
#include <array>
#include <limits>

namespace dismantle::sdf {

TriangleSlabs::TriangleSlabs(const Eigen::Vector3d& a, const Eigen::Vector3d& ab, const Eigen::Vector3d& ac,
                             double reach) {
  const Eigen::Vector3d corners[3] = {a, a + ab, a + ac};
  std::array<Eigen::Vector3d, 3> edges = {ab, ac, ac - ab};
  std::sort(edges.begin(), edges.end(), [](const auto& l, const auto& r) { return l.squaredNorm() > r.squaredNorm(); });
  const auto unit_or = [](const Eigen::Vector3d& v, const Eigen::Vector3d& otherwise) {
    const double length = v.stableNorm();
    return length > std::numeric_limits<double>::min() ? Eigen::Vector3d(v / length) : otherwise;
  };
  // Triangles without area have no plane: any axes bound them.
  const Eigen::Vector3d along = unit_or(edges[0], Eigen::Vector3d::UnitX());
  const Eigen::Vector3d beside = edges[1] - along.dot(edges[1]) * along;
  const Eigen::Vector3d across = unit_or(beside - along.dot(beside) * along, along.unitOrthogonal());
  const Eigen::Vector3d normal = along.cross(across).normalized();
  const Eigen::Vector3d axes[4] = {normal, along, across, unit_or(normal.cross(edges[1]), across)};
  // A dot product in single precision rounds each factor, product and sum, all bounded by the distances of point and
  // corner from the origin: 16 roundings of half an epsilon.
  const double rounding = 8.0 * std::numeric_limits<float>::epsilon() * reach;
  for (int k = 0; k < 4; ++k) {
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (const Eigen::Vector3d& corner : corners) {
      lo = std::min(lo, axes[k].dot(corner));
      hi = std::max(hi, axes[k].dot(corner));
    }
    x_[k] = static_cast<float>(axes[k].x());
    y_[k] = static_cast<float>(axes[k].y());
    z_[k] = static_cast<float>(axes[k].z());
    offset_[k] = static_cast<float>(-0.5 * (lo + hi));
    half_[k] = static_cast<float>(0.5 * (hi - lo) + rounding);
  }
}

}  // namespace dismantle::sdf
