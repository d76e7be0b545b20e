#include "dismantle/sdf/contact_points.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

namespace dismantle::sdf {
namespace {

struct Edge {
  Eigen::Vector3d a, b;
};

/// Edges where the surface bends outwards by more than `angle`.
std::vector<Edge> convex_edges(const Mesh& mesh, double angle) {
  struct Side {
    std::uint32_t triangle = 0;
    int corner = 0;
    bool paired = false;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Side> open;
  std::vector<Edge> result;
  const auto normal = [&](std::size_t t) -> Eigen::Vector3d {
    return (mesh.vertex(t, 1) - mesh.vertex(t, 0)).cross(mesh.vertex(t, 2) - mesh.vertex(t, 0)).stableNormalized();
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto from = mesh.triangles[t][static_cast<std::size_t>(k)];
      const auto to = mesh.triangles[t][static_cast<std::size_t>((k + 1) % 3)];
      const auto other = open.find({to, from});
      if (other == open.end() || other->second.paired) {
        open[{from, to}] = {t, k, false};
        continue;
      }
      other->second.paired = true;
      const std::uint32_t u = other->second.triangle;
      const Eigen::Vector3d nt = normal(t), nu = normal(u);
      const Eigen::Vector3d& apex = mesh.vertex(u, (other->second.corner + 2) % 3);
      const double bend = std::atan2(nt.cross(nu).norm(), nt.dot(nu));
      // Convex: the neighbour's apex lies below this triangle's plane.
      if (bend > angle && nt.dot(apex - mesh.vertex(t, k)) < 0)
        result.push_back({mesh.vertices[from], mesh.vertices[to]});
    }
  return result;
}

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
  const std::uint32_t half = (count / 2 + ContactPoints::kBlockSize - 1) / ContactPoints::kBlockSize * ContactPoints::kBlockSize;
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

ContactPoints sample_contact_points(const Mesh& mesh, const Mesh& surface, const ContactPointOptions& options) {
  const std::vector<Edge> edges = convex_edges(mesh, options.sharp_angle);
  double total = 0;
  for (const Edge& e : edges) total += (e.b - e.a).norm();
  double spacing = options.edge_spacing;
  const double room = static_cast<double>(options.max_points) - static_cast<double>(surface.vertices.size());
  if (total / spacing > std::max(room, 1000.0)) spacing = total / std::max(room, 1000.0);
  std::vector<Eigen::Vector3d> points = surface.vertices;
  for (const Edge& e : edges) {
    const int pieces = static_cast<int>(std::ceil((e.b - e.a).norm() / spacing));
    for (int i = 1; i < pieces; ++i) points.push_back(e.a + (e.b - e.a) * (static_cast<double>(i) / pieces));
  }
  // The subdivided surface has vertices on the same edges: drop what coincides.
  const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::sort(points.begin(), points.end(), less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return make_blocks(std::move(points));
}

}  // namespace dismantle::sdf
