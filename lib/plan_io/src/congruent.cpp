#include "dismantle/plan_io/congruent.h"

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <utility>

namespace dismantle {
namespace {

constexpr double kSameShape = 1e-4;  // of the part's size: files round coordinates to six digits

Eigen::Matrix3Xd columns_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = points[i];
  return out;
}

/// The displacement that takes the vertices of `a` to those of `b`, if there is one.
std::optional<Pose> displacement_between(const Mesh& a, const Mesh& b) {
  const double tolerance = kSameShape * a.box().size().norm();
  if (a.vertices.size() < 3 || !(tolerance > 0)) return std::nullopt;
  const Eigen::Matrix4d fit = Eigen::umeyama(columns_of(a.vertices), columns_of(b.vertices), false);
  if (!fit.allFinite()) return std::nullopt;
  const Eigen::Matrix3d rotation = fit.topLeftCorner<3, 3>();
  const Pose pose{fit.topRightCorner<3, 1>(), Eigen::Quaterniond(rotation).normalized()};
  for (std::size_t i = 0; i < a.vertices.size(); ++i)
    if ((pose * a.vertices[i] - b.vertices[i]).norm() > tolerance) return std::nullopt;
  return pose;
}

}  // namespace

std::vector<ShapePlacement> find_congruent(const std::vector<Part>& parts) {
  std::vector<ShapePlacement> out;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>>
      originals;  // by number of vertices, triangles
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Mesh& mesh = *parts[i].mesh;
    ShapePlacement placement{i, {}};
    auto& known = originals[{mesh.vertices.size(), mesh.triangles.size()}];
    for (const std::size_t original : known) {
      const Mesh& other = *parts[original].mesh;
      if (other.triangles != mesh.triangles) continue;
      if (const auto pose = displacement_between(other, mesh)) {
        placement = {original, *pose};
        break;
      }
    }
    if (placement.original == i) known.push_back(i);
    out.push_back(placement);
  }
  return out;
}

}  // namespace dismantle
