#include <Eigen/Eigenvalues>

#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/hull.h"
#include "dismantle/geometry/mesh_edges.h"
#include "dismantle/geometry/mesh_measure.h"
#include "mesh/cross2.h"

namespace dismantle {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Counter-clockwise convex hull (monotone chain).
std::vector<Vector2d> hull_2d(std::vector<Vector2d> p) {
  std::sort(p.begin(), p.end(),
            [](const auto& a, const auto& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  if (p.size() < 3) return p;
  std::vector<Vector2d> h(2 * p.size());
  std::size_t k = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    while (k >= 2 && cross2(h[k - 1] - h[k - 2], p[i] - h[k - 2]) <= 0) --k;
    h[k++] = p[i];
  }
  const std::size_t lower = k + 1;
  for (std::size_t i = p.size() - 1; i-- > 0;) {
    while (k >= lower && cross2(h[k - 1] - h[k - 2], p[i] - h[k - 2]) <= 0) --k;
    h[k++] = p[i];
  }
  h.resize(k > 1 ? k - 1 : k);
  return h;
}

/// Smallest rectangle around points in the plane, with a side along one of the (longest) hull edges.
Vector2d smallest_rectangle(const std::vector<Vector2d>& points) {
  const auto hull = hull_2d(points);
  std::vector<Vector2d> directions;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2d d = hull[(i + 1) % hull.size()] - hull[i];
    if (d.squaredNorm() > 0) directions.push_back(d);
  }
  std::stable_sort(directions.begin(), directions.end(),
                   [](const auto& a, const auto& b) { return a.squaredNorm() > b.squaredNorm(); });
  if (directions.size() > 128) directions.resize(128);
  if (directions.empty()) directions.emplace_back(1, 0);
  Vector2d best = Vector2d::Constant(std::numeric_limits<double>::infinity());
  for (Vector2d u : directions) {
    u.normalize();
    const Vector2d v(-u.y(), u.x());
    double lo_u = 1e308, hi_u = -1e308, lo_v = 1e308, hi_v = -1e308;
    for (const auto& p : hull) {
      lo_u = std::min(lo_u, u.dot(p));
      hi_u = std::max(hi_u, u.dot(p));
      lo_v = std::min(lo_v, v.dot(p));
      hi_v = std::max(hi_v, v.dot(p));
    }
    const Vector2d size(hi_u - lo_u, hi_v - lo_v);
    if (!(size.prod() >= best.prod())) best = size;
  }
  return best;
}

/// Candidate face directions of the smallest box: face normals with the most area, principal and coordinate axes.
std::vector<Vector3d> candidate_axes(const Mesh& mesh, std::span<const Vector3d> points) {
  std::vector<geometry::FaceAxis> faces;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d n = geometry::area_vector(mesh, t);
    if (const double area = n.norm(); area > 0) faces.push_back({n / area, area});
  }
  faces = geometry::rounded_axes(faces);
  geometry::sort_by_area(faces, 64);
  std::vector<Vector3d> axes;
  for (const auto& face : faces) axes.push_back(face.axis);
  Vector3d mean = Vector3d::Zero();
  for (const auto& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& p : points) covariance += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  for (int k = 0; k < 3; ++k) {
    axes.push_back(solver.eigenvectors().col(k));
    axes.push_back(Vector3d::Unit(k));
  }
  return axes;
}

}  // namespace

Eigen::Vector3d oriented_box(const Mesh& mesh) {
  if (mesh.vertices.empty()) return Vector3d::Zero();
  const auto points = hull_corners(mesh.vertices);
  Vector3d best = Vector3d::Constant(std::numeric_limits<double>::infinity());
  std::vector<Vector2d> flat(points.size());
  for (const Vector3d& n : candidate_axes(mesh, points)) {
    const Vector3d u = n.unitOrthogonal(), v = n.cross(u);
    double lo = 1e308, hi = -1e308;
    for (std::size_t i = 0; i < points.size(); ++i) {
      flat[i] = {u.dot(points[i] - points[0]), v.dot(points[i] - points[0])};
      lo = std::min(lo, n.dot(points[i] - points[0]));
      hi = std::max(hi, n.dot(points[i] - points[0]));
    }
    const Vector2d rectangle = smallest_rectangle(flat);
    const Vector3d size(hi - lo, rectangle.x(), rectangle.y());
    if (!(size.prod() >= best.prod())) best = size;
  }
  std::sort(best.data(), best.data() + 3);
  return best;
}

}  // namespace dismantle
