#include "blocking/rotation_axes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "blocking_graph/directions.h"
#include "dismantle/geometry/disjoint_sets.h"
#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle::blocking {
namespace {

using Vec3 = Eigen::Vector3d;

/// Share of the surface that slides on itself when it rotates about the axis.
double share_round(const Mesh& mesh, const Vec3& point, const Vec3& axis, const RoundSurface& round_surface) {
  // A triangle's centroid is off the middle of its facet by up to a third of half the facet's angle.
  const double off = std::sin(std::numbers::pi / (3 * round_surface.facets));
  double total = 0, round = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.vertex(t, 0), b = mesh.vertex(t, 1), c = mesh.vertex(t, 2);
    const Vec3 twice = (b - a).cross(c - a);
    const Vec3 around = axis.cross((a + b + c) / 3 - point);
    total += twice.norm();
    if (around.norm() < round_surface.tolerance || std::abs(twice.dot(around)) < off * twice.norm() * around.norm())
      round += twice.norm();
  }
  return total > 0 ? round / total : 1;
}

/// Connected coplanar triangles.
struct Facet {
  Vec3 normal = Vec3::Zero();
  double area = 0;
  std::vector<std::uint32_t> corners;
};

struct Facets {
  std::vector<Facet> all;
  std::vector<std::pair<std::size_t, std::size_t>> neighbours;  // pairs with a bend as in round surfaces
};

Facets facets_of(const Mesh& mesh, const RoundSurface& round_surface) {
  const double most_bend = std::cos(2 * std::numbers::pi / round_surface.facets);  // a larger bend is an edge
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> by_edge;
  std::vector<Vec3> twice(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    for (std::size_t k = 0; k < 3; ++k) by_edge[{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}] = t;
    twice[t] = geometry::area_vector(mesh, t);
  }
  DisjointSets sets(count);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> bent;
  for (const auto& [ends, t] : by_edge) {
    const auto other = by_edge.find({ends.second, ends.first});
    if (ends.first > ends.second || other == by_edge.end()) continue;
    const double bend = twice[t].dot(twice[other->second]) / (twice[t].norm() * twice[other->second].norm());
    if (bend > geometry::kSameDirection)
      sets.join(t, other->second);
    else if (bend > most_bend)
      bent.emplace_back(t, other->second);
  }
  Facets facets;
  std::vector<std::size_t> facet_of(count, 0);
  std::map<std::uint32_t, std::size_t> index;
  for (std::uint32_t t = 0; t < count; ++t) {
    const auto [entry, is_new] = index.try_emplace(sets.root(t), facets.all.size());
    if (is_new) facets.all.emplace_back();
    Facet& f = facets.all[facet_of[t] = entry->second];
    f.normal += twice[t];
    f.area += 0.5 * twice[t].norm();
    f.corners.insert(f.corners.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  }
  for (Facet& f : facets.all) f.normal.normalize();
  for (const auto& [a, b] : bent) facets.neighbours.push_back(std::minmax(facet_of[a], facet_of[b]));
  std::sort(facets.neighbours.begin(), facets.neighbours.end());
  facets.neighbours.erase(std::unique(facets.neighbours.begin(), facets.neighbours.end()), facets.neighbours.end());
  return facets;
}

}  // namespace

std::vector<RotationAxis> rotation_axes(const Mesh& mesh, std::size_t most, const RoundSurface& round_surface) {
  const Facets facets = facets_of(mesh, round_surface);
  const double across = std::sqrt(1 - geometry::kSameDirection * geometry::kSameDirection);
  double total = 0;
  for (const Facet& f : facets.all) total += f.area;
  std::vector<RotationAxis> found;
  for (const Vec3& d : axes_of(mesh, most)) {
    const auto middle = [&](const Facet& f) {  // midpoint of the facet's projection along d, a chord
      const Vec3 along = d.cross(f.normal);
      double lo = std::numeric_limits<double>::infinity(), hi = -lo;
      for (const std::uint32_t v : f.corners) {
        lo = std::min(lo, along.dot(mesh.vertices[v]));
        hi = std::max(hi, along.dot(mesh.vertices[v]));
      }
      return Vec3(0.5 * (lo + hi) * along + f.normal.dot(mesh.vertices[f.corners.front()]) * f.normal);
    };
    std::vector<RotationAxis> here;
    for (const auto& [i, j] : facets.neighbours) {
      const Facet &a = facets.all[i], &b = facets.all[j];
      if (std::abs(a.normal.dot(d)) > across || std::abs(b.normal.dot(d)) > across) continue;
      const Vec3 p = middle(a), q = middle(b);
      // The axis is at the p - s * a.normal that is also on the bisector of the other chord.
      const Vec3 along = d.cross(b.normal);
      const double rate = a.normal.dot(along);
      if (std::abs(rate) < 1e-3) continue;
      const Vec3 on_axis = p - (p - q).dot(along) / rate * a.normal;
      const Vec3 point = on_axis - on_axis.dot(d) * d;
      const double area = a.area + b.area;
      const auto same = std::find_if(here.begin(), here.end(), [&](const RotationAxis& k) {
        return (k.point - point).norm() < round_surface.tolerance;
      });
      if (same == here.end()) {
        here.push_back({point, d, area});
      } else {
        same->point = (same->area * same->point + area * point) / (same->area + area);
        same->area += area;
      }
    }
    found.insert(found.end(), here.begin(), here.end());
  }
  std::erase_if(found, [&](const RotationAxis& a) { return a.area < round_surface.share * total; });
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.area > b.area; });
  std::vector<RotationAxis> axes;
  for (const RotationAxis& a : found) {
    if (axes.size() == most) break;
    if (share_round(mesh, a.point, a.direction, round_surface) < 1 - round_surface.share) axes.push_back(a);
  }
  return axes;
}

}  // namespace dismantle::blocking
