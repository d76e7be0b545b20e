#include "dismantle/immobility/interior_circle.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/patch.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;
using std::numbers::pi;

double depth_at(const Solid& solid, const InteriorCircle& circle, double angle) {
  return escape_at(solid.frame.inverse() * point_on(circle, angle), solid).depth;
}

/// depth_at() > depth, without the distance of points that are outside, and of what is farther than it matters.
bool is_deeper(const Solid& solid, const InteriorCircle& circle, double angle, double depth) {
  const Vec3 p = solid.frame.inverse() * point_on(circle, angle);
  if (!(depth > geometry::kRounding * p.cwiseAbs().maxCoeff())) return escape_at(p, solid).depth > depth;
  return solid.box.contains(p) && solid.bvh.inside(p) && solid.bvh.closest(p, 2 * depth).distance > depth;
}

/// True if the whole arc between two angles is deeper than `depth`.
bool arc_is_deep(const Solid& solid, const InteriorCircle& circle, double depth, double from, double to) {
  const double middle = 0.5 * (from + to), half_arc = 0.5 * (to - from) * circle.radius;
  const double d = depth_at(solid, circle, middle);
  if (d > depth + half_arc) return true;
  if (!(d > depth) || half_arc < 0.05 * depth) return false;
  return arc_is_deep(solid, circle, depth, from, middle) && arc_is_deep(solid, circle, depth, middle, to);
}

}  // namespace

Vec3 point_on(const InteriorCircle& circle, double angle) {
  const Vec3 e = circle.axis.unitOrthogonal(), f = circle.axis.cross(e);
  return circle.center + circle.radius * (std::cos(angle) * e + std::sin(angle) * f);
}

bool is_deep(const Solid& solid, const InteriorCircle& circle, double depth) {
  return arc_is_deep(solid, circle, depth, 0, 2 * pi);
}

bool samples_are_deep(const Solid& solid, const InteriorCircle& circle, double depth) {
  for (int k = 0; k < 24; ++k)  // in steps of 5/24, so that a point outside is found early
    if (!is_deeper(solid, circle, 2 * pi * 5 * k / 24, depth)) return false;
  return true;
}

SymmetryAxes symmetry_axes_of(const Solid& solid) {
  const Mesh& mesh = solid.mesh;
  double area = 0;
  SymmetryAxes axes;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  std::vector<std::pair<double, Vec3>> faces;  // area and direction
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.vertex(t, 0), b = mesh.vertex(t, 1), c = mesh.vertex(t, 2);
    const double w = (b - a).cross(c - a).norm();
    area += w;
    axes.center += w * (a + b + c) / 3;
    for (const Vec3& p : {Vec3(0.5 * (a + b)), Vec3(0.5 * (b + c)), Vec3(0.5 * (c + a))})
      second += w / 3 * p * p.transpose();
    const auto same = std::find_if(faces.begin(), faces.end(), [&](const auto& f) {
      return std::abs(f.second.dot(solid.normals[t])) > kSameDirection;
    });
    if (same != faces.end())
      same->first += w;
    else if (faces.size() < 300)  // a surface with more directions is round, and its later triangles are small
      faces.emplace_back(w, solid.normals[t]);
  }
  axes.center /= area;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> inertia(second / area - axes.center * axes.center.transpose());
  for (int k = 0; k < 3; ++k) axes.all.push_back(inertia.eigenvectors().col(k));
  std::stable_sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [w, normal] : faces) {
    if (axes.all.size() == 6 || w < 0.02 * area) break;  // three of inertia, and three normals of larger faces
    if (std::none_of(axes.all.begin(), axes.all.end(),
                     [n = normal](const Vec3& known) { return std::abs(known.dot(n)) > kSameDirection; }))
      axes.all.push_back(normal);
  }
  return axes;
}

}  // namespace dismantle::immobility
