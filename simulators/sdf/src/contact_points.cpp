#include "dismantle/sdf/contact_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle::sdf {
namespace {

struct Edge {
  std::uint32_t from = 0, to = 0;
  double bend = 0;  ///< angle between the faces, > 0; convex only
};

struct Creases {
  std::vector<Edge> convex;
  std::vector<bool> sheltered;                   ///< per vertex: at a sharp concave edge and at no sharp convex one
  std::vector<std::vector<std::uint32_t>> ends;  ///< per vertex: other ends of its bent edges, convex or not
};

Creases find_creases(const Mesh& mesh, double sharp_angle) {
  struct Side {
    std::uint32_t triangle = 0;
    int corner = 0;
  };
  Creases result;
  result.ends.resize(mesh.vertices.size());
  std::vector<bool> folded(mesh.vertices.size()), sharp(mesh.vertices.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, Side> open;
  const auto normal = [&](std::size_t t) -> Eigen::Vector3d {
    return geometry::area_vector(mesh, t).stableNormalized();
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto from = mesh.triangles[t][static_cast<std::size_t>(k)];
      const auto to = mesh.triangles[t][static_cast<std::size_t>((k + 1) % 3)];
      const auto other = open.find({to, from});
      if (other == open.end()) {
        open[{from, to}] = {t, k};
        continue;
      }
      const Side u = other->second;
      open.erase(other);
      const Eigen::Vector3d nt = normal(t), nu = normal(u.triangle);
      const double bend = std::atan2(nt.cross(nu).norm(), nt.dot(nu));
      if (std::cos(bend) > geometry::kSameDirection) continue;  // inside a flat face
      result.ends[from].push_back(to);
      result.ends[to].push_back(from);
      // Convex: the neighbour's apex lies below this triangle's plane.
      const Eigen::Vector3d& apex = mesh.vertex(u.triangle, (u.corner + 2) % 3);
      const bool convex = nt.dot(apex - mesh.vertex(t, k)) < 0;
      if (convex) result.convex.push_back({from, to, bend});
      if (bend > sharp_angle) (convex ? sharp : folded)[from] = (convex ? sharp : folded)[to] = true;
    }
  result.sheltered.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) result.sheltered[v] = folded[v] && !sharp[v];
  return result;
}

/// False inside flat faces and on straight creases.
bool is_corner(const Mesh& mesh, const std::vector<std::uint32_t>& ends, std::uint32_t v) {
  if (ends.empty()) return false;
  if (ends.size() != 2) return true;
  const Eigen::Vector3d &a = mesh.vertices[ends[0]], &b = mesh.vertices[ends[1]];
  return !((mesh.vertices[v] - a).normalized().dot((b - mesh.vertices[v]).normalized()) > geometry::kSameDirection);
}

/// Keeps points at a distance of at least `distance` from all points kept before.
class Thinning {
 public:
  explicit Thinning(double distance) : distance_(distance) {}
  bool keep(const Eigen::Vector3d& p) {
    const auto cell = [&](int a, int d) { return static_cast<std::int64_t>(std::floor(p[a] / distance_)) + d; };
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto found = cells_.find({cell(0, x), cell(1, y), cell(2, z)});
          if (found == cells_.end()) continue;
          for (const auto& q : found->second)
            if ((p - q).squaredNorm() < distance_ * distance_) return false;
        }
    cells_[{cell(0, 0), cell(1, 0), cell(2, 0)}].push_back(p);
    return true;
  }

 private:
  double distance_;
  std::map<std::array<std::int64_t, 3>, std::vector<Eigen::Vector3d>> cells_;
};

void split(std::vector<Eigen::Vector3d>& points, std::uint32_t first, std::uint32_t count, ContactPoints& out) {
  if (count <= ContactPoints::kBlockSize) {
    PointBlock block{first, count, Eigen::Vector3d::Zero(), 0};
    Eigen::Vector3d lo = points[first], hi = points[first];
    for (std::uint32_t i = first; i < first + count; ++i) lo = lo.cwiseMin(points[i]), hi = hi.cwiseMax(points[i]);
    block.center = 0.5 * (lo + hi);
    for (std::uint32_t i = first; i < first + count; ++i)
      block.radius = std::max(block.radius, (points[i] - block.center).norm());
    out.blocks.push_back(block);
    return;
  }
  Eigen::Vector3d lo = points[first], hi = points[first];
  for (std::uint32_t i = first; i < first + count; ++i) lo = lo.cwiseMin(points[i]), hi = hi.cwiseMax(points[i]);
  Eigen::Index axis = 0;
  (hi - lo).maxCoeff(&axis);
  const std::uint32_t half =
      (count / 2 + ContactPoints::kBlockSize - 1) / ContactPoints::kBlockSize * ContactPoints::kBlockSize;
  const std::uint32_t left = half < count ? half : count / 2;
  const auto begin = points.begin() + first;
  std::nth_element(begin, begin + left, begin + count, [axis](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Eigen::Index i = (axis + k) % 3;
      if (a[i] != b[i]) return a[i] < b[i];
    }
    return false;
  });
  split(points, first, left, out);
  split(points, first + left, count - left, out);
}

}  // namespace

ContactPoints make_blocks(std::vector<Eigen::Vector3d> points) {
  ContactPoints out;
  if (!points.empty()) split(points, 0, static_cast<std::uint32_t>(points.size()), out);
  out.points = std::move(points);
  return out;
}

ContactPoints sample_contact_points(const Mesh& mesh, const ContactPointOptions& options) {
  const Creases creases = find_creases(mesh, options.sharp_angle);
  std::vector<Eigen::Vector3d> points;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    if (!creases.sheltered[v] && is_corner(mesh, creases.ends[v], v)) points.push_back(mesh.vertices[v]);

  double sharp_length = 0;
  for (const Edge& e : creases.convex)
    if (e.bend > options.sharp_angle) sharp_length += (mesh.vertices[e.to] - mesh.vertices[e.from]).norm();
  const double room = std::max(1000.0, static_cast<double>(options.max_points) - static_cast<double>(points.size()));
  const double spacing = std::max(options.spacing, sharp_length / room);

  // Sharp edges first; smooth edges then fill the remaining area.
  Thinning sharp(0.6 * spacing), smooth(0.8 * spacing);
  for (const bool want_sharp : {true, false})
    for (const Edge& e : creases.convex) {
      if ((e.bend > options.sharp_angle) != want_sharp) continue;
      const Eigen::Vector3d &a = mesh.vertices[e.from], &b = mesh.vertices[e.to];
      const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
      for (int i = 0; i <= pieces; ++i) {
        const bool end = i == 0 || i == pieces;
        const std::uint32_t v = i == 0 ? e.from : e.to;
        if (end && (creases.sheltered[v] || is_corner(mesh, creases.ends[v], v))) continue;
        const Eigen::Vector3d p = a + (b - a) * (static_cast<double>(i) / pieces);
        if ((want_sharp ? sharp : smooth).keep(p)) points.push_back(p);
      }
      if (points.size() >= options.max_points) break;
    }
  if (points.empty()) points = mesh.vertices;
  return make_blocks(std::move(points));
}

}  // namespace dismantle::sdf
