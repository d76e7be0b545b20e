#include "dismantle/sdf/wall_sides.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "dismantle/geometry/solid_angles.h"

namespace dismantle::sdf {
namespace {

using Vec3 = Eigen::Vector3d;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Edges that bound the surface, as its triangles run through them, once for each triangle without a counterpart.
std::vector<Edge> boundary_of(const Mesh& mesh) {
  std::map<Edge, int> uses;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      a < b ? ++uses[{a, b}] : --uses[{b, a}];
    }
  std::vector<Edge> out;
  for (const auto& [edge, count] : uses)
    for (int i = 0; i < std::abs(count); ++i) out.push_back(count > 0 ? edge : Edge{edge.second, edge.first});
  return out;
}

/// Edges that share corners, opening by opening, in the order of their first edges.
std::vector<std::vector<Edge>> openings_of(const Mesh& mesh) {
  const std::vector<Edge> edges = boundary_of(mesh);
  std::vector<std::uint32_t> group(mesh.vertices.size());
  std::iota(group.begin(), group.end(), 0u);
  const auto find = [&](std::uint32_t v) {
    while (group[v] != v) v = group[v] = group[group[v]];
    return v;
  };
  for (const auto& [a, b] : edges) group[find(a)] = find(b);
  std::map<std::uint32_t, std::size_t> known;
  std::vector<std::vector<Edge>> out;
  for (const Edge& edge : edges) {
    const auto [at, is_new] = known.try_emplace(find(edge.first), out.size());
    if (is_new) out.emplace_back();
    out[at->second].push_back(edge);
  }
  return out;
}

}  // namespace

WallSides::WallSides(const Mesh& mesh, const geometry::Poll& poll) : box_(mesh.box()) {
  Mesh closed = mesh;
  for (const std::vector<Edge>& opening : openings_of(mesh)) {
    Cap cap;
    cap.first = edges_.size();
    for (const auto& [a, b] : opening) {
      cap.apex += (mesh.vertices[a] + mesh.vertices[b]) / (2 * static_cast<double>(opening.size()));
      edges_.push_back({mesh.vertices[b], mesh.vertices[a]});  // the triangle of the cap runs the other way
    }
    cap.end = edges_.size();
    const auto furthest = [&] {
      double out = 0;
      for (std::size_t i = cap.first; i < cap.end; ++i) out = std::max(out, (edges_[i][0] - cap.apex).norm());
      return out;
    };
    // Beside the plane of the opening, in which there are points of parts that are flush with it: on a cap the side is
    // a matter of rounding.
    cap.apex += furthest() * Vec3(0.0831, 0.0577, 0.0713);
    cap.reach = furthest();
    const auto apex = static_cast<std::uint32_t>(closed.vertices.size());
    closed.vertices.push_back(cap.apex);
    for (const auto& [a, b] : opening) {
      closed.triangles.push_back({b, a, apex});
      cap.area += 0.5 * (mesh.vertices[a] - cap.apex).cross(mesh.vertices[b] - cap.apex).norm();
    }
    caps_.push_back(cap);
  }
  closed_ = TriangleBvh(closed, poll);
}

double WallSides::most(const Cap& cap, const Vec3& p) {
  const double distance = (p - cap.apex).norm() - cap.reach;
  return distance > 0 ? cap.area / (4 * std::numbers::pi * distance * distance)
                      : std::numeric_limits<double>::infinity();
}

double WallSides::share(const Cap& cap, const Vec3& p) const {
  SolidAngles sum;
  for (std::size_t i = cap.first; i < cap.end; ++i) sum.add(edges_[i][0] - p, edges_[i][1] - p, cap.apex - p);
  return sum.sum() / (4 * std::numbers::pi);
}

bool WallSides::inside(const Vec3& p) const {
  if (!box_.contains(p)) return false;
  constexpr double kSmall = 0.02;  // of the view: what is left unmeasured at first
  const double wanted = closed_.winding_number(p) - 0.5;
  double caps = 0, unmeasured = 0;
  for (const Cap& cap : caps_) {
    if (const double at_most = most(cap, p); at_most < kSmall)
      unmeasured += at_most;
    else
      caps += share(cap, p);
  }
  if (std::abs(wanted - caps) <= unmeasured)
    for (const Cap& cap : caps_)
      if (most(cap, p) < kSmall) caps += share(cap, p);
  return caps < wanted;
}

}  // namespace dismantle::sdf
