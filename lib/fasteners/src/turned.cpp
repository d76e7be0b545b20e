#include "turned.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "dismantle/geometry/face_axes.h"

namespace dismantle::fasteners {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Face {
  Vector3d normal, center;
  double area;
};

std::vector<Face> faces_of(const Mesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d a = geometry::area_vector(mesh, t);
    const double area = a.norm() / 2;
    if (area > 0)
      faces.push_back({a / (2 * area), (mesh.vertex(t, 0) + mesh.vertex(t, 1) + mesh.vertex(t, 2)) / 3, area});
  }
  return faces;
}

constexpr double kAlong = 0.98;  ///< length across the axis of the normals of faces that run along it

/// The point that the normals of a turned surface pass by: least absolute distances, by reweighted squares.
Vector3d point_on(const std::vector<Face>& faces, const Vector3d& axis, const Vector3d& start) {
  const Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  const auto across = [&](const Vector3d& p) { return Vector2d(u.dot(p - start), v.dot(p - start)); };
  double scale = 0, total = 0, along = 0;
  for (const Face& f : faces) {
    scale += f.area * across(f.center).norm();
    total += f.area;
    if (Vector2d(u.dot(f.normal), v.dot(f.normal)).norm() > kAlong) along += f.area;
  }
  scale /= total;
  // Flanks of threads pass by the axis; faces along the axis say more, if there are enough of them.
  const double least = along > 0.1 * total ? kAlong : 0.3;
  Vector2d at = Vector2d::Zero();
  for (int round = 0; round < 8; ++round) {
    Eigen::Matrix2d m = 1e-12 * total * Eigen::Matrix2d::Identity();
    Vector2d right = 1e-12 * total * at;
    for (const Face& f : faces) {
      Vector2d n(u.dot(f.normal), v.dot(f.normal));
      const double length = n.norm();
      if (length < least) continue;
      n /= length;
      const Vector2d side(-n.y(), n.x()), c = across(f.center);
      const double off = std::abs(side.dot(c - at));
      const double weight = f.area * length / (round == 0 ? 1.0 : std::max(off / scale, 1e-3));
      m += weight * side * side.transpose();
      right += weight * side * side.dot(c);
    }
    at = m.ldlt().solve(right);
  }
  return start + at.x() * u + at.y() * v;
}

double share_turned(const std::vector<Face>& faces, const Vector3d& axis, const Vector3d& point) {
  double turned = 0, total = 0;
  for (const Face& f : faces) {
    total += f.area;
    const double along = std::abs(f.normal.dot(axis));
    if (along > 0.999) {
      turned += f.area;
      continue;
    }
    const Vector3d radius = (f.center - point) - axis * axis.dot(f.center - point);
    const double r = radius.norm();
    if (r > 0 && std::abs(radius.cross(f.normal).dot(axis)) < 0.15 * r)
      turned += f.area;
    else if (along < 0.02)
      turned += f.area / 2;
  }
  return turned / total;
}

}  // namespace

std::optional<TurnedAxis> turned_axis(const Mesh& mesh) {
  const std::vector<Face> faces = faces_of(mesh);
  if (faces.empty()) return std::nullopt;
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero(), spread = Eigen::Matrix3d::Zero();
  Vector3d middle = Vector3d::Zero();
  double total = 0;
  std::vector<geometry::FaceAxis> flat;
  for (const Face& f : faces) {
    normals += f.area * f.normal * f.normal.transpose();
    middle += f.area * f.center;
    total += f.area;
    flat.push_back({f.normal, f.area});
  }
  middle /= total;
  for (const Face& f : faces) spread += f.area * (f.center - middle) * (f.center - middle).transpose();
  flat = geometry::rounded_axes(flat);
  geometry::sort_by_area(flat, 4);
  std::vector<Vector3d> candidates;
  for (const auto& axis : flat) candidates.push_back(axis.axis.normalized());
  for (const Eigen::Matrix3d& m : {normals, spread}) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m);
    for (int i = 0; i < 3; ++i) candidates.push_back(solver.eigenvectors().col(i));
  }
  std::optional<TurnedAxis> best;
  std::vector<Vector3d> tried;
  for (const Vector3d& axis : candidates) {
    if (std::any_of(tried.begin(), tried.end(), [&](const Vector3d& t) { return std::abs(t.dot(axis)) > 0.999999; }))
      continue;
    tried.push_back(axis);
    const Vector3d point = point_on(faces, axis, middle);
    const double share = share_turned(faces, axis, point);
    if (!best || share > best->share + 1e-6) best = TurnedAxis{axis, point, share};
  }
  return best;
}

double roundness(const Mesh& mesh, const Vector3d& axis, const Vector3d& point) {
  constexpr std::size_t kTangents = 72;
  const Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  std::array<Vector2d, kTangents> normals;
  for (std::size_t i = 0; i < kTangents; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kTangents;
    normals[i] = {std::cos(angle), std::sin(angle)};
  }
  std::array<double, kTangents> widths{};  // an axis outside has some of 0
  double farthest = 0;
  for (const Vector3d& p : mesh.vertices) {
    const Vector2d at(u.dot(p - point), v.dot(p - point));
    farthest = std::max(farthest, at.norm());
    for (std::size_t i = 0; i < kTangents; ++i) widths[i] = std::max(widths[i], normals[i].dot(at));
  }
  return farthest > 0 ? *std::min_element(widths.begin(), widths.end()) / farthest : 0;
}

Turned::Turned(const Mesh& mesh, const Vector3d& axis, const Vector3d& point)
    : mesh_(&mesh), axis_(axis), point_(point), u_(axis.unitOrthogonal()), v_(axis.cross(u_)) {
  local_.reserve(mesh.vertices.size());
  for (const Vector3d& p : mesh.vertices)
    local_.emplace_back(u_.dot(p - point), v_.dot(p - point), axis.dot(p - point));
  low_ = high_ = local_.empty() ? 0 : local_.front().z();
  for (const Vector3d& p : local_) low_ = std::min(low_, p.z()), high_ = std::max(high_, p.z());
}

Section Turned::section(double z) const {
  Section s;
  s.z = z;
  s.outer.fill(0);
  s.inner.fill(0);
  std::array<int, kRays> crossings{};
  constexpr double kStep = 2 * std::numbers::pi / kRays;
  for (const Triangle& t : mesh_->triangles) {
    std::array<Vector2d, 2> ends;
    std::size_t found = 0;
    bool first_up = false;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vector3d &a = local_[t[c]], &b = local_[t[(c + 1) % 3]];
      const bool up = b.z() > z;
      if ((a.z() > z) == up) continue;
      const double share = (z - a.z()) / (b.z() - a.z());
      if (found == 0) first_up = up;
      if (found < 2) ends[found++] = a.head<2>() + share * (b.head<2>() - a.head<2>());
    }
    if (found < 2) continue;
    // Where the outline runs counter-clockwise seen against the axis, the material is on its left.
    if (first_up) std::swap(ends[0], ends[1]);
    const Vector2d displacement = ends[1] - ends[0];
    s.area += (ends[0].x() * ends[1].y() - ends[0].y() * ends[1].x()) / 2;
    double from = std::atan2(ends[0].y(), ends[0].x()) / kStep, to = std::atan2(ends[1].y(), ends[1].x()) / kStep;
    if (to - from > kRays / 2.0) from += kRays;
    if (from - to > kRays / 2.0) to += kRays;
    if (from > to) std::swap(from, to);
    // Rays lie half a step off the axes, where faces often are.
    for (auto k = static_cast<long>(std::ceil(from - 0.37)); k + 0.37 <= to; ++k) {
      const double angle = (static_cast<double>(k) + 0.37) * kStep;
      const Vector2d ray(std::cos(angle), std::sin(angle));
      const double down = ray.x() * displacement.y() - ray.y() * displacement.x();
      if (down == 0) continue;
      const double r = (ends[0].x() * displacement.y() - ends[0].y() * displacement.x()) / down;
      if (!(r > 0)) continue;
      const auto ray_index = static_cast<std::size_t>(((k % long{kRays}) + long{kRays}) % long{kRays});
      if (crossings[ray_index] == 0 || r < s.inner[ray_index]) s.inner[ray_index] = r;
      s.outer[ray_index] = std::max(s.outer[ray_index], r);
      ++crossings[ray_index];
    }
  }
  s.area = std::abs(s.area);
  std::size_t odd = 0;
  for (const int n : crossings) {
    odd += static_cast<std::size_t>(n % 2);
    s.crossed += n > 0;
  }
  s.filled = 2 * odd > kRays;
  return s;
}

std::vector<Loop> Turned::loops(double z) const {
  // Each edge that the plane cuts ends one piece of an outline and begins the next.
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  const auto edge = [&](std::uint32_t a, std::uint32_t b) { return Edge(std::min(a, b), std::max(a, b)); };
  const auto point = [&](const Edge& e) -> Vector2d {
    const Vector3d &a = local_[e.first], &b = local_[e.second];
    return a.head<2>() + (z - a.z()) / (b.z() - a.z()) * (b.head<2>() - a.head<2>());
  };
  std::map<Edge, Edge> next;
  for (const Triangle& t : mesh_->triangles) {
    std::optional<Edge> up, down;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = t[c], b = t[(c + 1) % 3];
      if ((local_[a].z() > z) != (local_[b].z() > z)) (local_[b].z() > z ? up : down) = edge(a, b);
    }
    if (up && down) next[*down] = *up;
  }
  std::vector<Loop> out;
  while (!next.empty()) {
    std::vector<Vector2d> corners;
    for (auto at = next.begin(); at != next.end();) {
      corners.push_back(point(at->first));
      const Edge to = at->second;
      next.erase(at);
      at = next.find(to);
    }
    Loop loop;
    double twice = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector2d a = corners[i] - corners[0], b = corners[(i + 1) % corners.size()] - corners[0];
      const double part = a.x() * b.y() - a.y() * b.x();
      twice += part;
      loop.center += part * (a + b) / 3;
    }
    loop.center = corners[0] + (twice != 0 ? Vector2d(loop.center / twice) : Vector2d(0, 0));
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector2d a = corners[i] - loop.center, b = corners[(i + 1) % corners.size()] - loop.center, side = b - a;
      const double share = side.squaredNorm() > 0 ? std::clamp(-a.dot(side) / side.squaredNorm(), 0.0, 1.0) : 0;
      const double near = (a + share * side).norm();
      loop.smallest = i == 0 ? near : std::min(loop.smallest, near);
      loop.largest = std::max(loop.largest, a.norm());
      loop.area += (a.x() * b.y() - a.y() * b.x()) / 2;
    }
    // From falling edges to rising ones, outer outlines run counter-clockwise.
    loop.hole = loop.area < 0;
    loop.area = std::abs(loop.area);
    out.push_back(loop);
  }
  return out;
}

double Section::outer_max() const { return *std::max_element(outer.begin(), outer.end()); }

static double smallest_met(const Radii& radii) {
  double out = 0;
  for (const double r : radii)
    if (r > 0 && (out == 0 || r < out)) out = r;
  return out;
}

double Section::inner_min() const { return smallest_met(inner); }

Outline outline_of(const Radii& radii) {
  Outline out;
  out.smallest = smallest_met(radii);
  out.largest = *std::max_element(radii.begin(), radii.end());
  const double swing = out.largest - out.smallest;
  if (swing < 0.03 * out.largest && std::find(radii.begin(), radii.end(), 0.0) == radii.end()) {
    out.fold = 0;
    return out;
  }
  // A ray that meets nothing is as long as the longest.
  const auto at = [&](std::size_t k) { return radii[k % kRays] > 0 ? radii[k % kRays] : out.largest; };
  for (const std::size_t n : {2, 3, 4, 6}) {
    double off = 0;
    for (std::size_t k = 0; k < kRays; ++k) off += std::abs(at(k) - at(k + kRays / n));
    if (off / kRays < 0.12 * swing) out.fold = static_cast<int>(n);
  }
  return out;
}

}  // namespace dismantle::fasteners
