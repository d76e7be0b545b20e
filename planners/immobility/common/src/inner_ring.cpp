#include "dismantle/immobility/inner_ring.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "dismantle/geometry/patch.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;
using std::numbers::pi;

constexpr int kGlance = 24;             // points at which a ring is looked at first
constexpr double kParallel = 0.999999;  // cosine of the angle between directions that are the same
constexpr std::size_t kFaces = 300;     // directions of faces that are told apart

}  // namespace

Vec3 point_on(const InnerRing& ring, double angle) {
  const Vec3 e = ring.axis.unitOrthogonal(), f = ring.axis.cross(e);
  return ring.center + ring.radius * (std::cos(angle) * e + std::sin(angle) * f);
}

/// Is all of the arc deeper than that? Depths change no faster than the point moves.
bool is_deep(const Solid& solid, const InnerRing& ring, double depth, double from, double to, int halvings) {
  const double middle = 0.5 * (from + to), d = escape_at(solid.frame.inverse() * point_on(ring, middle), solid).depth;
  if (d > depth + 0.5 * (to - from) * ring.radius) return true;
  if (!(d > depth) || halvings == 0) return false;
  return is_deep(solid, ring, depth, from, middle, halvings - 1) &&
         is_deep(solid, ring, depth, middle, to, halvings - 1);
}

bool looks_deep(const Solid& solid, const InnerRing& ring, double depth) {
  for (int k = 0; k < kGlance; ++k)
    if (!(escape_at(solid.frame.inverse() * point_on(ring, 2 * pi * ((5 * k) % kGlance) / kGlance), solid).depth >
          depth))
      return false;
  return true;
}

RoundAxes round_axes_of(const Solid& solid) {
  const Mesh& mesh = solid.mesh;
  double area = 0;
  RoundAxes axes;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  std::vector<std::pair<double, Vec3>> faces;  // by direction
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.vertex(t, 0), b = mesh.vertex(t, 1), c = mesh.vertex(t, 2);
    const double w = (b - a).cross(c - a).norm();
    area += w;
    axes.center += w * (a + b + c) / 3;
    for (const Vec3& p : {Vec3(0.5 * (a + b)), Vec3(0.5 * (b + c)), Vec3(0.5 * (c + a))})
      second += w / 3 * p * p.transpose();
    const auto same = std::find_if(faces.begin(), faces.end(),
                                   [&](const auto& f) { return std::abs(f.second.dot(solid.normals[t])) > kParallel; });
    if (same != faces.end())
      same->first += w;
    else if (faces.size() < kFaces)
      faces.emplace_back(w, solid.normals[t]);
  }
  axes.center /= area;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> inertia(second / area - axes.center * axes.center.transpose());
  for (int k = 0; k < 3; ++k) axes.all.push_back(inertia.eigenvectors().col(k));
  std::stable_sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [w, normal] : faces) {
    if (axes.all.size() == 6 || w < 0.02 * area) break;
    if (std::none_of(axes.all.begin(), axes.all.end(),
                     [n = normal](const Vec3& known) { return std::abs(known.dot(n)) > kParallel; }))
      axes.all.push_back(normal);
  }
  return axes;
}

}  // namespace dismantle::immobility
