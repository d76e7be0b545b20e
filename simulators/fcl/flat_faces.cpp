#include "flat_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <vector>

#include "dismantle/geometry/numerics.h"

namespace dismantle::mesh_collision {
namespace {

using Eigen::Vector3d;
using Id = std::uint32_t;

class Collapser {
 public:
  Collapser(const Mesh& mesh, double tolerance)
      : points_(mesh.vertices),
        triangles_(mesh.triangles),
        alive_(triangles_.size(), true),
        around_(points_.size()),
        tolerance_(tolerance) {
    for (Id t = 0; t < triangles_.size(); ++t)
      for (const Id v : triangles_[t]) around_[v].push_back(t);
    find_faces();
  }

  Mesh run() {
    for (bool changed = true; changed;) {
      changed = false;
      for (Id v = 0; v < points_.size(); ++v) changed |= remove(v);
    }
    Mesh out;
    std::vector<Id> renamed(points_.size(), geometry::kNoIndex);
    for (Id t = 0; t < triangles_.size(); ++t) {
      if (!alive_[t]) continue;
      Triangle mapped{};
      for (std::size_t k = 0; k < 3; ++k) {
        Id& name = renamed[triangles_[t][k]];
        if (name == geometry::kNoIndex) {
          name = static_cast<Id>(out.vertices.size());
          out.vertices.push_back(points_[triangles_[t][k]]);
        }
        mapped[k] = name;
      }
      out.triangles.push_back(mapped);
    }
    return out;
  }

 private:
  Vector3d cross(const Triangle& t) const {
    return (points_[t[1]] - points_[t[0]]).cross(points_[t[2]] - points_[t[0]]);
  }
  /// Twice the area over the square of the longest edge: 0 for a sliver.
  double quality(const Triangle& t) const {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, (points_[t[(k + 1) % 3]] - points_[t[k]]).squaredNorm());
    return longest > 0 ? cross(t).norm() / longest : 0;
  }

  /// Flood fill from the largest triangles, whose planes are the most accurate.
  void find_faces() {
    std::map<std::pair<Id, Id>, std::vector<Id>> edges;
    for (Id t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) edges[std::minmax(triangles_[t][k], triangles_[t][(k + 1) % 3])].push_back(t);
    std::vector<Id> order(triangles_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::vector<double> area;
    for (const auto& t : triangles_) area.push_back(cross(t).norm());
    std::stable_sort(order.begin(), order.end(), [&](Id a, Id b) { return area[a] > area[b]; });
    face_.assign(triangles_.size(), geometry::kNoIndex);
    for (const Id seed : order) {
      if (face_[seed] != geometry::kNoIndex) continue;
      const Id face = static_cast<Id>(normal_.size());
      const Vector3d n = cross(triangles_[seed]).stableNormalized();
      const double d = n.dot(points_[triangles_[seed][0]]);
      normal_.push_back(n);
      face_[seed] = face;
      std::vector<Id> open{seed};
      while (!open.empty()) {
        const Triangle t = triangles_[open.back()];
        open.pop_back();
        for (std::size_t k = 0; k < 3; ++k)
          for (const Id other : edges.at(std::minmax(t[k], t[(k + 1) % 3]))) {
            if (face_[other] != geometry::kNoIndex) continue;
            const Triangle& o = triangles_[other];
            const bool in_plane =
                std::all_of(o.begin(), o.end(), [&](Id v) { return std::abs(n.dot(points_[v]) - d) <= tolerance_; });
            if (!in_plane || !(cross(o).stableNormalized().dot(n) >= geometry::kSameDirection)) continue;
            face_[other] = face;
            open.push_back(other);
          }
      }
    }
  }

  std::vector<Id> neighbors(Id v) const {
    std::vector<Id> all;
    for (const Id t : around_[v])
      for (const Id w : triangles_[t])
        if (w != v) all.push_back(w);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  std::vector<Id> faces_along(Id v, Id w) const {  // faces of the triangles at the edge
    std::vector<Id> all;
    for (const Id t : around_[v])
      if (std::find(triangles_[t].begin(), triangles_[t].end(), w) != triangles_[t].end()) all.push_back(face_[t]);
    return all;
  }

  bool remove(Id v) {
    if (around_[v].empty()) return false;
    std::vector<Id> faces;
    for (const Id t : around_[v])
      if (std::find(faces.begin(), faces.end(), face_[t]) == faces.end()) faces.push_back(face_[t]);
    if (faces.size() > 2) return false;
    std::vector<Id> onto = neighbors(v);
    if (faces.size() == 2) {  // only along the edge between both faces, and only if it is straight here
      std::erase_if(onto, [&](Id w) {
        const auto f = faces_along(v, w);
        return f.size() != 2 || f[0] == f[1];
      });
      if (onto.size() != 2) return false;
      const Vector3d a = points_[onto[0]], along = points_[onto[1]] - a, p = points_[v] - a;
      if (p.dot(along) <= 0 || p.cross(along).norm() > tolerance_ * along.norm()) return false;
    }
    double best = 1e-5;  // of quality(): below it a triangle is a sliver
    Id target = geometry::kNoIndex;
    for (const Id u : onto)
      if (const auto q = worst_after(v, u); q && *q > best) best = *q, target = u;
    if (target == geometry::kNoIndex) return false;
    collapse(v, target);
    return true;
  }

  /// Quality of the worst triangle after collapsing v onto u; nothing if that would fold or pinch the surface.
  std::optional<double> worst_after(Id v, Id u) const {
    const auto nv = neighbors(v), nu = neighbors(u);
    std::vector<Id> common;
    std::set_intersection(nv.begin(), nv.end(), nu.begin(), nu.end(), std::back_inserter(common));
    if (common.size() != 2 || faces_along(v, u).size() != 2) return std::nullopt;
    double worst = 1;
    for (const Id t : around_[v]) {
      Triangle moved = triangles_[t];
      if (std::find(moved.begin(), moved.end(), u) != moved.end()) continue;
      std::replace(moved.begin(), moved.end(), v, u);
      if (!(cross(moved).dot(normal_[face_[t]]) > 0)) return std::nullopt;
      worst = std::min(worst, quality(moved));
    }
    return worst;
  }

  void collapse(Id v, Id u) {
    for (const Id t : around_[v]) {
      Triangle& tri = triangles_[t];
      if (std::find(tri.begin(), tri.end(), u) != tri.end()) {
        alive_[t] = false;
        for (const Id w : tri)
          if (w != v) std::erase(around_[w], t);
      } else {
        std::replace(tri.begin(), tri.end(), v, u);
        around_[u].push_back(t);
      }
    }
    around_[v].clear();
  }

  std::vector<Vector3d> points_;
  std::vector<Triangle> triangles_;
  std::vector<bool> alive_;
  std::vector<std::vector<Id>> around_;  ///< triangles at each vertex
  std::vector<Id> face_;                 ///< by triangle
  std::vector<Vector3d> normal_;         ///< by face
  double tolerance_;
};

}  // namespace

Mesh merge_flat_faces(const Mesh& mesh, double tolerance) { return Collapser(mesh, tolerance).run(); }

}  // namespace dismantle::mesh_collision
