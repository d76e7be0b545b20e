#include "body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "dismantle/errors.h"
#include "dismantle/geometry/disjoint_sets.h"
#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/hull.h"
#include "dismantle/geometry/mass_properties.h"
#include "dismantle/geometry/numerics.h"
#include "flat_faces.h"

namespace dismantle::mesh_collision {
namespace {

Eigen::Vector3d face_normal(const Mesh& mesh, std::size_t t) {
  return geometry::area_vector(mesh, t).stableNormalized();
}

/// Root of each vertex among those joined by triangles.
std::vector<std::uint32_t> shell_roots(const Mesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 1; k < 3; ++k) sets.join(t[0], t[k]);
  std::vector<std::uint32_t> root(mesh.vertices.size());
  for (std::uint32_t v = 0; v < root.size(); ++v) root[v] = sets.root(v);
  return root;
}

/// Unit vector w that maximises the minimum dot product with the given unit normals, by moving it repeatedly towards
/// the worst of them (Badoiu and Clarkson's scheme for smallest balls, on the sphere).
Eigen::Vector3d into_all(const std::vector<Eigen::Vector3d>& inward, double& least) {
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
  for (const auto& n : inward) w += n;
  if (w.norm() < 1e-9) w = inward.front();
  w.normalize();
  Eigen::Vector3d best = w;
  least = -1;
  for (int round = 1; round <= 60; ++round) {
    double worst = 2;
    const Eigen::Vector3d* pull = nullptr;
    for (const auto& n : inward)
      if (const double d = n.dot(w); d < worst) worst = d, pull = &n;
    if (worst > least) {
      least = worst;
      best = w;
    }
    const Eigen::Vector3d next = w + *pull * (2.0 / (round + 1.0));
    if (next.norm() < 1e-9) break;
    w = next.normalized();
  }
  return best;
}

Inset make_inset(const Mesh& mesh, const std::vector<SolidPart>& solids, const std::vector<std::uint32_t>& shells,
                 double depth) {
  std::vector<Eigen::Vector3d> vertices = mesh.vertices;
  const auto displacements = inset_displacements(mesh, solids, depth);
  for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] += displacements[v];
  Inset inset{depth, CollisionMesh(vertices, mesh.triangles), {}};
  for (const auto v : shells) inset.shell_points.push_back(vertices[v]);
  return inset;
}

}  // namespace

double signed_distance(const std::vector<SolidPart>& solids, const Eigen::Vector3d& p, double limit) {
  double least = limit;
  for (const auto& s : solids) {
    if (s.box.squared_distance(p) > 0 && s.box.squared_distance(p) >= least * least) continue;
    const sdf::Sample sample =
        s.surface->sample(p, s.box.contains(p) ? std::numeric_limits<double>::infinity() : std::max(least, 0.0));
    if (sample.triangle != geometry::kNoIndex) least = std::min(least, sample.value);
  }
  return least;
}

EdgeGraph edge_graph(const Mesh& mesh) {
  EdgeGraph graph;
  graph.of_triangle.resize(mesh.triangles.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::pair<std::uint32_t, std::uint32_t> ends =
          std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      const auto [at, fresh] = known.try_emplace(ends, static_cast<std::uint32_t>(graph.edges.size()));
      if (fresh) graph.edges.push_back({ends.first, ends.second});
      graph.of_triangle[t][k] = at->second;
    }
  graph.vertex_begin.assign(mesh.vertices.size() + 1, 0);
  for (const auto& e : graph.edges)
    for (const auto v : e) ++graph.vertex_begin[v + 1];
  std::partial_sum(graph.vertex_begin.begin(), graph.vertex_begin.end(), graph.vertex_begin.begin());
  graph.vertex_edges.resize(2 * graph.edges.size());
  std::vector<std::uint32_t> next(graph.vertex_begin.begin(), graph.vertex_begin.end() - 1);
  for (std::uint32_t e = 0; e < graph.edges.size(); ++e)
    for (const auto v : graph.edges[e]) graph.vertex_edges[next[v]++] = e;
  const auto root = shell_roots(mesh);
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const auto& t : mesh.triangles) used[root[t[0]]] = true;
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (used[v]) graph.shell_vertex.push_back(v);
  return graph;
}

std::vector<Eigen::Vector3d> inset_displacements(const Mesh& mesh, const std::vector<SolidPart>& solids, double depth) {
  std::vector<std::vector<Eigen::Vector3d>> inward(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d n = -face_normal(mesh, t);
    if (n.squaredNorm() < 0.5) continue;  // no area, no direction
    for (const auto v : mesh.triangles[t]) {
      auto& known = inward[v];
      if (std::none_of(known.begin(), known.end(), [&](const auto& k) { return (k - n).squaredNorm() < 1e-12; }))
        known.push_back(n);
    }
  }
  std::vector<Eigen::Vector3d> displacements(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (std::size_t v = 0; v < displacements.size(); ++v) {
    if (inward[v].empty()) continue;
    double least = 0;
    const Eigen::Vector3d w = into_all(inward[v], least);
    if (!(least > 0.05)) continue;
    // The copy of a wall must not turn inside out, since it would let thin parts pass.
    const auto inside = [&](double length) { return signed_distance(solids, mesh.vertices[v] + length * w) < 0; };
    double length = depth;
    for (int halving = 0; halving < 12 && !(inside(length) && inside(2 * length) && inside(4 * length)); ++halving)
      length /= 2;
    if (!inside(length)) continue;
    displacements[v] = length * w;
  }
  return displacements;
}

std::shared_ptr<const Body> make_body(const Part& part, const std::vector<double>& depths) {
  // Coordinates in files have single precision.
  const double flat = std::numeric_limits<float>::epsilon() * part.mesh->box().size().norm();
  Mesh mesh = merge_flat_faces(*part.mesh, flat);
  // Merging creates fans and slivers, so it must remove at least 30 % of the triangles.
  if (10 * mesh.triangles.size() > 7 * part.mesh->triangles.size()) mesh = *part.mesh;
  std::vector<SolidPart> solids;
  for (const sdf::Solid& solid : sdf::split_solids(mesh))
    solids.push_back({solid.mesh, solid.mesh.box(), std::make_unique<sdf::SurfaceQuery>(solid)});
  if (solids.empty()) throw InputError(part.name, "encloses no volume");
  EdgeGraph graph = edge_graph(mesh);
  auto body = std::make_shared<Body>(Body{mesh,
                                          mesh.box(),
                                          std::move(solids),
                                          std::move(graph),
                                          CollisionMesh(mesh.vertices, mesh.triangles),
                                          hull_corners(mesh.vertices),
                                          mass_properties(mesh).center,
                                          0,
                                          {}});
  for (const auto& v : mesh.vertices) body->radius = std::max(body->radius, (v - body->center).norm());
  for (const double depth : depths)
    body->insets.emplace(depth, make_inset(mesh, body->solids, body->graph.shell_vertex, depth));
  return body;
}

}  // namespace dismantle::mesh_collision
