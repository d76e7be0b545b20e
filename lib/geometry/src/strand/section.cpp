#include "strand/section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edge_of(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

/// Point at which the cut leaves an edge, and the next edge that it meets.
struct Crossing {
  Edge next;
  Vec3 at;
};

/// One crossing per triangle that the plane divides. A corner in the plane counts as above it, so that every outline of
/// a closed mesh is a closed chain.
std::map<Edge, Crossing> crossings(const Mesh& mesh, const TriangleBvh& bvh, const Vec3& point, const Vec3& normal,
                                   double reach) {
  std::map<Edge, Crossing> found;
  Aabb box;
  box.extend(point);
  box.inflate(reach);
  bvh.overlapping(box, point, normal, [&](std::uint32_t t) {
    const Triangle& v = mesh.triangles[t];
    std::array<double, 3> height;
    for (std::size_t k = 0; k < 3; ++k) height[k] = normal.dot(mesh.vertices[v[k]] - point);
    std::optional<Edge> down, up;
    Vec3 at = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t n = (k + 1) % 3;
      if ((height[k] >= 0) == (height[n] >= 0)) continue;
      if (height[k] < 0) {
        up = edge_of(v[k], v[n]);
        continue;
      }
      down = edge_of(v[k], v[n]);
      // Interpolate from the same end for both triangles of the edge.
      const bool first = v[k] < v[n];
      const double h0 = first ? height[k] : height[n], h1 = first ? height[n] : height[k];
      const Vec3 &p0 = mesh.vertices[down->first], &p1 = mesh.vertices[down->second];
      at = p0 + h0 / (h0 - h1) * (p1 - p0);
    }
    if (down && up) found[*down] = {*up, at};
  });
  return found;
}

bool holds(const std::vector<Vec3>& rim, const Vec3& point, const Vec3& u, const Vec3& v) {
  bool inside = false;
  for (std::size_t k = 0; k < rim.size(); ++k) {
    const Vec3 a = rim[k] - point, b = rim[(k + 1) % rim.size()] - point;
    const double ax = a.dot(u), ay = a.dot(v), bx = b.dot(u), by = b.dot(v);
    if ((ay > 0) == (by > 0)) continue;
    if (ax + ay / (ay - by) * (bx - ax) > 0) inside = !inside;
  }
  return inside;
}

Section measured(std::vector<Vec3> rim, const Vec3& point, const Vec3& normal) {
  Section out;
  Vec3 moment = Vec3::Zero();
  for (std::size_t k = 0; k < rim.size(); ++k) {
    const Vec3 a = rim[k] - point, b = rim[(k + 1) % rim.size()] - point;
    const double twice = normal.dot(a.cross(b));
    out.area += 0.5 * twice;
    moment += twice / 6 * (a + b);
    out.outline += (b - a).norm();
  }
  out.center = point + moment / out.area;
  out.rim = std::move(rim);
  return out;
}

}  // namespace

std::optional<Section> section_around(const Mesh& mesh, const TriangleBvh& bvh, const Vec3& point, const Vec3& normal,
                                      double reach) {
  std::map<Edge, Crossing> open = crossings(mesh, bvh, point, normal, reach);
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  std::optional<Section> best;
  while (!open.empty()) {
    const Edge begin = open.begin()->first;
    std::vector<Vec3> rim;
    Edge at = begin;
    for (auto next = open.find(at); next != open.end(); next = open.find(at)) {
      rim.push_back(next->second.at);
      at = next->second.next;
      open.erase(next);
    }
    if (at != begin || rim.size() < 3 || !holds(rim, point, u, v)) continue;  // open, or not around the point
    Section here = measured(std::move(rim), point, normal);
    if (here.area < 0) {
      std::reverse(here.rim.begin(), here.rim.end());
      here.area = -here.area;
    }
    if (here.area > 0 && (!best || here.area > best->area)) best = std::move(here);
  }
  return best;
}

}  // namespace dismantle::geometry
