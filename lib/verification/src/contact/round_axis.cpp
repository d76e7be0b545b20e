#include "contact/round_axis.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace dismantle::verify {
namespace {

using Vec3 = Eigen::Vector3d;
using Vec2 = Eigen::Vector2d;

constexpr std::size_t kSectors = 8;  // each has a place if the overlap surrounds the axis
constexpr double kRadial = 0.5;      // least cosine between a normal and the radial direction

/// The point nearest to all lines along normals, projected to the plane perpendicular to the axis; coordinates (u, v).
std::optional<Vec2> center_of(const std::vector<FittedPlace>& places, const Vec3& u, const Vec3& v) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  Vec2 right = Vec2::Zero();
  for (const FittedPlace& f : places) {
    const Vec2 n(f.normal.dot(u), f.normal.dot(v));
    if (n.norm() < kRadial) continue;
    const Vec2 across = Vec2(-n.y(), n.x()).normalized(), x(f.point.dot(u), f.point.dot(v));
    sum += f.weight * across * across.transpose();
    right += f.weight * across * across.dot(x);
  }
  if (!(sum.determinant() > 1e-6 * sum.trace() * sum.trace())) return std::nullopt;  // parallel normals
  return sum.inverse() * right;
}

bool all_around(const std::vector<FittedPlace>& places, const Vec3& u, const Vec3& v, const Vec2& center) {
  std::array<std::array<bool, kSectors>, 2> filled{};  // normals away from the axis, and towards it
  for (const FittedPlace& f : places) {
    const Vec2 arm = Vec2(f.point.dot(u), f.point.dot(v)) - center;
    const double outward = Vec2(f.normal.dot(u), f.normal.dot(v)).dot(arm.normalized());
    if (!(std::abs(outward) >= kRadial)) continue;
    const double turns = std::atan2(arm.y(), arm.x()) / (2 * std::numbers::pi) + 0.5;
    const auto sector = std::min(static_cast<std::size_t>(turns * kSectors), kSectors - 1);
    filled[outward > 0 ? 0 : 1][sector] = true;
  }
  const auto complete = [](const auto& sectors) {
    return std::all_of(sectors.begin(), sectors.end(), [](bool b) { return b; });
  };
  return complete(filled[0]) || complete(filled[1]);
}

}  // namespace

std::optional<RoundAxis> round_axis(const std::vector<FittedPlace>& places) {
  double weight = 0;
  Vec3 mean = Vec3::Zero(), middle = Vec3::Zero();
  for (const FittedPlace& f : places) {
    weight += f.weight;
    mean += f.weight * f.normal;
    middle += f.weight * f.point;
  }
  if (!(weight > 0)) return std::nullopt;
  mean /= weight;
  middle /= weight;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const FittedPlace& f : places) spread += f.weight / weight * (f.normal - mean) * (f.normal - mean).transpose();
  if (spread.trace() < 0.02) return std::nullopt;  // a variance: the normals deviate from their mean by 8 degrees (rms)
  // Normals of a cylinder vary least along its axis; those of threads and cones need not.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = eigen.eigenvectors().col(k), u = axis.unitOrthogonal(), v = axis.cross(u);
    const std::optional<Vec2> center = center_of(places, u, v);
    if (!center || !all_around(places, u, v, *center)) continue;
    return RoundAxis{center->x() * u + center->y() * v + middle.dot(axis) * axis, axis};
  }
  return std::nullopt;
}

}  // namespace dismantle::verify
