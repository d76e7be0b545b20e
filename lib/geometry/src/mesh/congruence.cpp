#include "dismantle/geometry/congruence.h"

#include <Eigen/Geometry>
#include <cstddef>

namespace dismantle::geometry {

std::optional<Pose> congruence(const Mesh& a, const Mesh& b, double tolerance) {
  if (a.vertices.size() != b.vertices.size() || a.triangles != b.triangles || a.vertices.size() < 3)
    return std::nullopt;
  // Three vertices that span a large triangle determine the motion; all others must agree with it.
  const auto farthest = [&](const auto& measure) {
    std::size_t best = 0;
    double value = -1;
    for (std::size_t i = 0; i < a.vertices.size(); ++i)
      if (const double m = measure(a.vertices[i]); m > value) value = m, best = i;
    return best;
  };
  const std::size_t i0 = farthest([&](const Eigen::Vector3d& v) { return (v - a.vertices[0]).squaredNorm(); });
  const std::size_t i1 = farthest([&](const Eigen::Vector3d& v) { return (v - a.vertices[i0]).squaredNorm(); });
  const Eigen::Vector3d line = (a.vertices[i1] - a.vertices[i0]).stableNormalized();
  const std::size_t i2 =
      farthest([&](const Eigen::Vector3d& v) { return (v - a.vertices[i0]).cross(line).squaredNorm(); });
  const auto frame = [&](const Mesh& m) {
    Eigen::Matrix3d f;
    f.col(0) = (m.vertices[i1] - m.vertices[i0]).stableNormalized();
    const Eigen::Vector3d u = m.vertices[i2] - m.vertices[i0];
    f.col(1) = (u - u.dot(f.col(0)) * f.col(0)).stableNormalized();
    f.col(2) = f.col(0).cross(f.col(1));
    return f;
  };
  Pose pose;
  pose.q = Eigen::Quaterniond(frame(b) * frame(a).transpose()).normalized();
  pose.t = b.vertices[i0] - pose.q * a.vertices[i0];
  for (std::size_t i = 0; i < a.vertices.size(); ++i)
    if (!((pose * a.vertices[i] - b.vertices[i]).cwiseAbs().maxCoeff() <= tolerance)) return std::nullopt;
  return pose;
}

}  // namespace dismantle::geometry
