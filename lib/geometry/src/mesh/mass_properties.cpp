#include "dismantle/geometry/mass_properties.h"

namespace dismantle {

MassProperties mass_properties(const Mesh& mesh) {
  MassProperties m;
  const Eigen::Vector3d origin = mesh.box().center();  // near the surface, for accuracy far from the world's origin
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();    // integral of x x^T
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d canonical = Eigen::Matrix3d::Constant(1.0 / 120.0);
  canonical.diagonal().setConstant(1.0 / 60.0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Eigen::Matrix3d edges;
    edges << mesh.vertex(t, 0) - origin, mesh.vertex(t, 1) - origin, mesh.vertex(t, 2) - origin;
    const double det = edges.determinant();
    m.volume += det / 6.0;
    first += det / 24.0 * (edges.col(0) + edges.col(1) + edges.col(2));
    second += det * edges * canonical * edges.transpose();
  }
  if (m.volume > 0) {
    const Eigen::Vector3d c = first / m.volume;
    m.center = origin + c;
    second -= m.volume * c * c.transpose();
    m.inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  } else {
    m.center = origin;
  }
  return m;
}

}  // namespace dismantle
