#include <cmath>
#include <limits>
#include <memory>

#include "dismantle/geometry/disjoint_sets.h"
#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/mesh_edges.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/mesh_repair.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle {
namespace {

using Eigen::Vector3d;
using mesh_detail::EdgeRef;

// Each triangle has two sides: 2 t in front of it (where its normal points), 2 t + 1 behind it.
std::uint32_t front(std::uint32_t t) { return 2 * t; }
std::uint32_t back(std::uint32_t t) { return 2 * t + 1; }

/// Side of the triangle that faces increasing angles around its edge (seen against lo -> hi), and its other side.
std::uint32_t ahead(const EdgeRef& e) { return e.forward ? front(e.triangle) : back(e.triangle); }
std::uint32_t behind(const EdgeRef& e) { return e.forward ? back(e.triangle) : front(e.triangle); }

/// Joins the sides that face each other around one edge.
void join_around(const Mesh& mesh, const EdgeRef* first, const EdgeRef* last, DisjointSets& sides) {
  const auto n = static_cast<std::size_t>(last - first);
  if (n < 2) return;
  std::vector<std::pair<double, const EdgeRef*>> fan;
  const Vector3d axis = (mesh.vertices[first->hi] - mesh.vertices[first->lo]).normalized();
  const Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  for (const auto* e = first; e < last; ++e) {
    const Vector3d w = mesh.vertices[mesh.triangles[e->triangle][(e->corner + 2) % 3u]] - mesh.vertices[first->lo];
    fan.emplace_back(n == 2 ? 0.0 : std::atan2(v.dot(w), u.dot(w)), e);
  }
  std::stable_sort(fan.begin(), fan.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < n; ++i) sides.join(ahead(*fan[i].second), behind(*fan[(i + 1) % n].second));
}

/// A side among `members` that is visible from infinity: the last one hit by a ray through one of them.
std::uint32_t outer_side(const Mesh& mesh, const std::vector<std::uint32_t>& members) {
  std::uint32_t largest = members.front();
  double largest_area = -1;
  for (const auto t : members) {
    const double area = geometry::area_vector(mesh, t).squaredNorm();
    if (area > largest_area) {
      largest = t;
      largest_area = area;
    }
  }
  const Vector3d through = (mesh.vertex(largest, 0) + mesh.vertex(largest, 1) + mesh.vertex(largest, 2)) / 3;
  const Vector3d normal = geometry::area_vector(mesh, largest).normalized();
  std::uint32_t side = front(largest);
  for (int attempt = 0; attempt < 8; ++attempt) {
    // Tilted against the normal by irregular angles, so that the ray misses the edges of regular shapes.
    const double turn = 0.7368 + 1.3217 * attempt;
    const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
    const Vector3d d = (normal + (0.0871 + 0.0313 * attempt) * (std::cos(turn) * u + std::sin(turn) * v)).normalized();
    double far = -1, far_margin = 0;
    for (const auto t : members) {
      const Vector3d n = geometry::area_vector(mesh, t);
      const double slope = n.dot(d), area = n.norm();
      if (std::abs(slope) < 1e-9 * area || area == 0) continue;
      const double s = t == largest ? 0 : n.dot(mesh.vertex(t, 0) - through) / slope;
      if (s < 0 || s <= far) continue;
      const Vector3d p = through + s * d;
      double margin = std::numeric_limits<double>::infinity();
      for (int c = 0; c < 3; ++c) {
        const Vector3d &a = mesh.vertex(t, c), &b = mesh.vertex(t, (c + 1) % 3);
        margin = std::min(margin, (b - a).cross(p - a).dot(n) / (area * area));
      }
      if (margin < -1e-9) continue;
      far = s;
      far_margin = margin;
      side = slope > 0 ? front(t) : back(t);
    }
    if (far_margin > 1e-6) break;
  }
  return side;
}

void flip(Triangle& t) { std::swap(t[1], t[2]); }

}  // namespace

OrientResult orient_outward(Mesh& mesh) {
  OrientResult result;
  const auto edges = mesh_detail::sorted_edges(mesh);
  DisjointSets sides(2 * mesh.triangles.size());
  mesh_detail::for_each_edge(edges, [&](const EdgeRef* f, const EdgeRef* l) { join_around(mesh, f, l, sides); });
  std::size_t count = 0;
  const auto shell = shells_of(mesh, count);
  std::vector<char> crowded(count, 0);
  mesh_detail::for_each_edge(edges, [&](const EdgeRef* f, const EdgeRef* l) {
    if (l - f > 2) crowded[shell[f->triangle]] = 1;
  });
  std::vector<std::vector<std::uint32_t>> members(count);
  for (std::uint32_t t = 0; t < shell.size(); ++t) members[shell[t]].push_back(t);

  std::vector<char> drop(mesh.triangles.size(), 0);
  for (std::size_t s = 0; s < count; ++s) {
    const std::uint32_t outside = sides.root(outer_side(mesh, members[s]));
    for (const auto t : members[s]) {
      const bool f = sides.root(front(t)) == outside, b = sides.root(back(t)) == outside;
      if (f && b && !crowded[s]) {
        result.one_sided = true;
        break;
      }
      if (f == b) {
        drop[t] = 1;
        ++result.membranes;
      } else if (b) {
        flip(mesh.triangles[t]);
        ++result.flipped;
      }
    }
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < drop.size(); ++t)
    if (!drop[t]) mesh.triangles[kept++] = mesh.triangles[t];
  mesh.triangles.resize(kept);
  return result;
}

namespace {

struct Shell {
  Mesh mesh;  // with its own copy of the vertices
  Aabb box;
  double volume = 0;
  std::vector<std::uint32_t> inside_of;  // shells that contain all of it
};

std::vector<Shell> split_shells(const Mesh& mesh, const std::vector<std::uint32_t>& shell, std::size_t count) {
  std::vector<Shell> shells(count);
  std::vector<std::vector<std::uint32_t>> members(count);
  for (std::uint32_t t = 0; t < shell.size(); ++t) members[shell[t]].push_back(t);
  std::vector<std::uint32_t> index(mesh.vertices.size(), 0), owner(mesh.vertices.size(), geometry::kNoIndex);
  for (std::uint32_t s = 0; s < count; ++s) {
    Mesh& own = shells[s].mesh;
    for (const auto t : members[s]) {
      Triangle copy = mesh.triangles[t];
      for (auto& v : copy) {
        if (owner[v] != s) {
          owner[v] = s;
          index[v] = static_cast<std::uint32_t>(own.vertices.size());
          own.vertices.push_back(mesh.vertices[v]);
        }
        v = index[v];
      }
      own.triangles.push_back(copy);
    }
    shells[s].box = own.box();
    shells[s].volume = signed_volume(own);
  }
  return shells;
}

/// True when points spread over `inner` are all inside of `outer`.
bool contains(const TriangleBvh& outer, const Mesh& inner) {
  const std::size_t samples = std::min<std::size_t>(inner.triangles.size(), 24);
  for (std::size_t k = 0; k < samples; ++k) {
    const std::size_t t = k * inner.triangles.size() / samples;
    if (outer.winding_number((inner.vertex(t, 0) + inner.vertex(t, 1) + inner.vertex(t, 2)) / 3) == 0) return false;
  }
  return true;
}

}  // namespace

ShellResult orient_shells(Mesh& mesh, bool trusted) {
  ShellResult result;
  const auto shell = shells_of(mesh, result.shells);
  auto shells = split_shells(mesh, shell, result.shells);
  for (std::uint32_t a = 0; a < shells.size(); ++a) {
    std::unique_ptr<TriangleBvh> bvh;
    for (std::uint32_t b = 0; b < shells.size(); ++b) {
      if (a == b || !shells[a].box.contains(shells[b].box.lo) || !shells[a].box.contains(shells[b].box.hi)) continue;
      if (!bvh) bvh = std::make_unique<TriangleBvh>(shells[a].mesh);
      if (contains(*bvh, shells[b].mesh)) shells[b].inside_of.push_back(a);
    }
  }
  std::vector<char> turn(shells.size(), 0);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    const auto& in = shells[s].inside_of;
    bool outward = in.size() % 2 == 0;
    if (trusted && !in.empty()) {
      // Orientation of the file, relative to the outermost shell around it.
      bool root_negative = false;
      for (const auto a : in)
        if (shells[a].inside_of.empty()) {
          root_negative = shells[a].volume < 0;
          break;
        }
      outward = (shells[s].volume > 0) != root_negative;
    }
    turn[s] = (shells[s].volume > 0) != outward && shells[s].volume != 0;
    result.turned += static_cast<std::size_t>(turn[s]);
    result.voids += !outward;
    result.inner_solids += outward && in.size() % 2 == 1;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (turn[shell[t]]) flip(mesh.triangles[t]);
  return result;
}

}  // namespace dismantle
