#include "dismantle/geometry/mesh_edges.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

/// True if the segment (p, q) crosses the interior of the triangle with more than `margin` on all sides.
bool pierces(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Corners& t, double margin) {
  Eigen::Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double area = n.norm();
  if (!(area > 0)) return false;
  n /= area;
  const double dp = n.dot(p - t[0]), dq = n.dot(q - t[0]);
  if (!((dp > margin && dq < -margin) || (dp < -margin && dq > margin))) return false;
  const Eigen::Vector3d x = p + dp / (dp - dq) * (q - p);
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::Vector3d edge = t[(c + 1) % 3] - t[c];
    const double length = edge.norm();
    if (!(length > 0) || n.dot(edge.cross(x - t[c])) <= margin * length) return false;
  }
  return true;
}

bool cross(const Corners& a, const Corners& b, double margin) {
  for (std::size_t c = 0; c < 3; ++c)
    if (pierces(a[c], a[(c + 1) % 3], b, margin) || pierces(b[c], b[(c + 1) % 3], a, margin)) return true;
  return false;
}

bool share_vertex(const Triangle& a, const Triangle& b) {
  for (const auto x : a)
    if (x == b[0] || x == b[1] || x == b[2]) return true;
  return false;
}

/// Triangles looked at for each of the mesh, on average: the boxes of slivers that meet in a corner all overlap.
constexpr std::size_t kPairs = 1000;

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> self_crossings(const Mesh& mesh, std::size_t limit,
                                                                    std::size_t max_tested) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
  if (mesh.empty() || limit == 0 || max_tested == 0) return found;
  const TriangleBvh bvh(mesh);
  const double margin = 1e-7 * mesh.box().size().norm();  // about the rounding of coordinates in files
  const std::size_t n = mesh.triangles.size(), tested = std::min(n, max_tested);
  std::size_t left = kPairs * n;
  for (std::size_t k = 0; k < tested && found.size() < limit && left > 0; ++k) {
    const auto t = static_cast<std::uint32_t>(k * n / tested);
    Aabb box;
    for (const auto& p : bvh.corners(t)) box.extend(p);
    bvh.overlapping(box, [&](std::uint32_t other) {
      if (found.size() >= limit || left == 0) return;
      --left;
      if (tested == n ? other <= t : other == t) return;
      if (!share_vertex(mesh.triangles[t], mesh.triangles[other]) && cross(bvh.corners(t), bvh.corners(other), margin))
        found.emplace_back(std::min(t, other), std::max(t, other));
    });
  }
  return found;
}

}  // namespace dismantle
