#include "dismantle/push_search/frame.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "dismantle/geometry/face_axes.h"

namespace dismantle::push {
namespace {

using Vec3 = Eigen::Vector3d;
using geometry::FaceAxis;

std::vector<FaceAxis> facings(const Assembly& assembly, const std::vector<PlacedPart>& parts) {
  std::vector<FaceAxis> all;
  for (const PlacedPart& p : parts) {
    if (p.part >= assembly.parts.size()) continue;  // a world may move parts without a mesh
    const Mesh& mesh = *assembly.parts[p.part].mesh;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vec3 n = p.pose.q * geometry::area_vector(mesh, t);
      if (const double size = n.norm(); size > 1e-12) all.push_back({n / size, size});
    }
  }
  geometry::sort_by_area(all);
  return all;
}

/// The axis with the most area among those perpendicular to `to` (zero: among all); zero if there is none.
Vec3 main_axis(const std::vector<FaceAxis>& all, const Vec3& to, double facet_angle) {
  std::vector<FaceAxis> axes;
  for (const FaceAxis& f : all)
    if (std::abs(f.axis.dot(to)) <= std::sin(facet_angle)) geometry::add_face(axes, f, std::cos(facet_angle));
  FaceAxis best{Vec3::Zero(), 0};
  for (const FaceAxis& a : axes)
    if (a.area > best.area * (1 + 1e-6)) best = a;
  return best.axis;
}

Vec3 furthest_from(const Assembly& assembly, const std::vector<PlacedPart>& parts, const Vec3& axis) {
  Vec3 mean = Vec3::Zero(), best = Vec3::Zero();
  double count = 0;
  for (const bool measure : {false, true}) {
    for (const PlacedPart& p : parts) {
      if (p.part >= assembly.parts.size()) continue;
      for (const auto& v : assembly.parts[p.part].mesh->vertices) {
        const Vec3 x = p.pose * v;
        if (!measure) {
          mean += x;
          ++count;
          continue;
        }
        const Vec3 across = (x - mean) - axis * axis.dot(x - mean);
        if (across.norm() > best.norm() * (1 + 1e-6)) best = across;
      }
    }
    if (count > 0 && !measure) mean /= count;
  }
  return best;
}

Aabb box_along(const Assembly& assembly, const std::vector<PlacedPart>& parts, const Eigen::Matrix3d& axes) {
  Aabb box;
  for (const PlacedPart& p : parts) {
    if (p.part >= assembly.parts.size()) continue;
    const Eigen::Matrix3d turn = axes.transpose() * p.pose.q.toRotationMatrix();
    const Vec3 shift = axes.transpose() * p.pose.t;
    for (const auto& v : assembly.parts[p.part].mesh->vertices) box.extend(turn * v + shift);
  }
  return box;
}

}  // namespace

Eigen::Matrix3d own_axes(const Assembly& assembly, const Scene& scene, double facet_angle) {
  const auto moving = facings(assembly, scene.moving);
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  const Vec3 first = main_axis(moving, Vec3::Zero(), facet_angle);
  if (first.isZero(0)) return axes;
  Vec3 second = main_axis(moving, first, facet_angle);
  if (second.isZero(0)) second = main_axis(facings(assembly, scene.fixed), first, facet_angle);
  if (second.isZero(0)) second = furthest_from(assembly, scene.moving, first);
  second -= first * first.dot(second);
  if (second.norm() < 1e-9) second = first.unitOrthogonal();
  axes.col(0) = first;
  axes.col(1) = second.normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

Extents::Extents(const Assembly& assembly, const Scene& scene, const Eigen::Matrix3d& axes)
    : axes_(axes), moving_(box_along(assembly, scene.moving, axes)), fixed_(box_along(assembly, scene.fixed, axes)) {}

double Extents::longest_exit() const { return (moving_.hi - moving_.lo).norm() + (fixed_.hi - fixed_.lo).norm(); }

double Extents::exit_distance(const Vec3& direction) const {
  const Vec3 d = axes_.transpose() * direction;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (d[k] > 1e-9) least = std::min(least, (fixed_.hi[k] - moving_.lo[k]) / d[k]);
    if (d[k] < -1e-9) least = std::min(least, (fixed_.lo[k] - moving_.hi[k]) / d[k]);
  }
  return least;
}

}  // namespace dismantle::push
