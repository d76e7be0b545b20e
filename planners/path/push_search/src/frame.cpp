#include "dismantle/push/frame.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace dismantle::push {
namespace {

using Vec3 = Eigen::Vector3d;

/// So many of the largest triangles tell the axes: more add nothing but the facets of round faces.
constexpr std::size_t kMostTriangles = 600;
/// Normals closer than this (cosine) belong to one axis, whichever way they point.
constexpr double kSameAxis = 0.9994;
/// Sine within which two normals count as square to each other.
constexpr double kSquare = 0.02;

struct Facing {
  Vec3 normal;  // unit
  double area;
};

std::vector<Facing> facings(const Assembly& assembly, const std::vector<PlacedPart>& parts) {
  std::vector<Facing> all;
  for (const PlacedPart& p : parts) {
    if (p.part >= assembly.parts.size()) continue;  // a world may move what has no mesh
    const Mesh& mesh = *assembly.parts[p.part].mesh;
    for (const Triangle& t : mesh.triangles) {
      const Vec3 n =
          p.pose.q * (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
      if (const double size = n.norm(); size > 1e-12) all.push_back({n / size, size});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Facing& a, const Facing& b) { return a.area > b.area; });
  if (all.size() > kMostTriangles) all.resize(kMostTriangles);
  return all;
}

/// The axis with most area among those that are square to `to` (zero: all); zero when there is none.
Vec3 main_axis(const std::vector<Facing>& all, const Vec3& to) {
  std::vector<Facing> axes;
  for (const Facing& f : all) {
    if (std::abs(f.normal.dot(to)) > kSquare) continue;
    const auto same = std::find_if(axes.begin(), axes.end(),
                                   [&](const Facing& a) { return std::abs(a.normal.dot(f.normal)) > kSameAxis; });
    if (same != axes.end())
      same->area += f.area;
    else
      axes.push_back(f);
  }
  Facing best{Vec3::Zero(), 0};
  for (const Facing& a : axes)
    if (a.area > best.area * (1 + 1e-6)) best = a;
  return best.normal;
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

Eigen::Matrix3d own_axes(const Assembly& assembly, const Scene& scene) {
  const auto moving = facings(assembly, scene.moving);
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  const Vec3 first = main_axis(moving, Vec3::Zero());
  if (first.isZero(0)) return axes;
  Vec3 second = main_axis(moving, first);
  if (second.isZero(0)) second = main_axis(facings(assembly, scene.fixed), first);
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

double Extents::way_out(const Vec3& direction) const {
  const Vec3 d = axes_.transpose() * direction;
  double way = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (d[k] > 1e-9) way = std::min(way, (fixed_.hi[k] - moving_.lo[k]) / d[k]);
    if (d[k] < -1e-9) way = std::min(way, (fixed_.lo[k] - moving_.hi[k]) / d[k]);
  }
  return way;
}

}  // namespace dismantle::push
