// Flat faces, convex edges and corners of a surface, and which of them a point can run into.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "dismantle/sdf/surface_query.h"

namespace dismantle::sdf {
void SurfaceQuery::find_faces(const Solid& solid) {
  const Mesh& mesh = solid.mesh;
  const auto n = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<std::vector<std::uint32_t>> around(mesh.vertices.size());
  for (std::uint32_t t = 0; t < n; ++t)
    for (const std::uint32_t v : mesh.triangles[t]) around[v].push_back(t);
  face_of_.assign(n, geometry::kNoIndex);
  std::vector<std::uint32_t> pending;
  for (std::uint32_t seed = 0; seed < n; ++seed) {
    if (face_of_[seed] != geometry::kNoIndex) continue;
    const auto id = static_cast<std::uint32_t>(planes_.size());
    const Plane plane{face_[seed], face_[seed].dot(mesh.vertex(seed, 0))};
    planes_.push_back(plane);
    face_of_[seed] = id;
    pending.assign(1, seed);
    while (!pending.empty()) {
      const std::uint32_t t = pending.back();
      pending.pop_back();
      for (const std::uint32_t v : mesh.triangles[t])
        for (const std::uint32_t u : around[v]) {
          if (face_of_[u] != geometry::kNoIndex || face_[u].dot(plane.normal) < 0.5) continue;
          bool flat = true;
          for (int k = 0; k < 3 && flat; ++k)
            flat = std::abs(plane.normal.dot(mesh.vertex(u, k)) - plane.offset) <= coplanar_;
          if (!flat) continue;
          face_of_[u] = id;
          pending.push_back(u);
        }
    }
  }
}

void SurfaceQuery::find_convex_features(const Solid& solid) {
  const double flat = std::numeric_limits<float>::epsilon();  // sine of a bend due to rounding
  const Mesh& mesh = solid.mesh;
  const auto n = static_cast<std::uint32_t>(mesh.triangles.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, std::size_t>> open;
  neighbor_.assign(n, {geometry::kNoIndex, geometry::kNoIndex, geometry::kNoIndex});
  std::vector<bool> convex(mesh.vertices.size(), true);
  for (std::uint32_t t = 0; t < n; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
      const auto other = open.find({to, from});
      if (other == open.end()) {
        open[{from, to}] = {t, k};
        continue;
      }
      const auto [u, j] = other->second;
      open.erase(other);
      const Eigen::Vector3d along = (mesh.vertices[to] - mesh.vertices[from]).stableNormalized();
      // Positive if the edge is convex seen from outside.
      const double bend = face_[t].cross(face_[u]).dot(along);
      if (bend > flat || (std::abs(bend) <= flat && face_[t].dot(face_[u]) < 0)) {
        neighbor_[t][k] = u;
        neighbor_[u][j] = t;
      } else if (bend < -flat) {
        convex[from] = convex[to] = false;
      }
    }
  std::vector<std::vector<std::uint32_t>> fans(mesh.vertices.size());
  for (std::uint32_t t = 0; t < n; ++t)
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (!convex[v]) continue;
      const bool known = std::any_of(fans[v].begin(), fans[v].end(),
                                     [&](std::uint32_t f) { return (face_[f] - face_[t]).squaredNorm() < 1e-8; });
      if (!known) fans[v].push_back(t);
    }
  fan_begin_.push_back(0);
  for (const auto& fan : fans) {
    fan_.insert(fan_.end(), fan.begin(), fan.end());
    fan_begin_.push_back(static_cast<std::uint32_t>(fan_.size()));
  }
}

int SurfaceQuery::planes(const Eigen::Vector3d& p, const Sample& sample, double near, FacePlane* out) const {
  const std::uint32_t t = sample.triangle, slot = slot_[t];
  const Corner& c = corners_[slot];
  const auto f = static_cast<std::size_t>(sample.feature);
  int count = 0;
  const auto add = [&](std::uint32_t face, const Eigen::Vector3d& on) {
    if (count == kMaxPlanes) return;
    for (int i = 0; i < count; ++i)
      if ((out[i].normal - face_[face]).squaredNorm() < 1e-8) return;
    out[count++] = {face_[face], face_[face].dot(p - on)};
  };
  if (f >= 4) {
    const std::uint32_t v = indices_[t][f - 4];
    const Eigen::Vector3d on = f == 4 ? c.a : f == 5 ? Eigen::Vector3d(c.a + c.ab) : Eigen::Vector3d(c.a + c.ac);
    for (std::uint32_t i = fan_begin_[v]; i < fan_begin_[v + 1]; ++i) add(fan_[i], on);
    return count > 1 ? count : 0;
  }
  const Eigen::Vector3d corner[3] = {c.a, c.a + c.ab, c.a + c.ac};
  const Eigen::Vector3d q = p - sample.offset;
  for (std::size_t k = 0; k < 3; ++k) {
    if (neighbor_[t][k] == geometry::kNoIndex) continue;
    const Eigen::Vector3d along = corner[(k + 1) % 3] - corner[k];
    const bool on_edge = f == k + 1;
    if (!on_edge && (q - corner[k]).cross(along).squaredNorm() > near * near * along.squaredNorm()) continue;
    add(t, corner[k]);
    add(neighbor_[t][k], corner[k]);
  }
  return count > 1 ? count : 0;
}

double SurfaceQuery::surroundings(const Eigen::Vector3d& p, const FacePlane* fronts, int front_count, double reach,
                                  double behind, FacePlane* out, int& count) const {
  const double smooth = std::cos(std::numbers::pi / 6);
  if (!cells_ || !cells_->covers(p)) return 0;
  const CandidateList& list = cells_->at(p, [this](const Eigen::Vector3d& center) { return candidates_of(center, 0); });
  if (!list.usable) return 0;
  const double off = (p - list.center).norm();
  double certain = std::min(reach, list.reach - off);
  const auto meet = [&](std::uint32_t slot) {
    const Plane& plane = planes_[face_of_[triangle_[slot]]];
    const double gap = plane.normal.dot(p) - plane.offset;
    if (gap < -behind || gap >= certain) return;
    // A triangle behind all fronts is out of reach.
    const Corner& k = corners_[slot];
    bool in_reach = false;
    for (int i = 0; i < front_count && !in_reach; ++i) {
      const double here = fronts[i].gap + fronts[i].normal.dot(k.a - p);
      const double highest = here + std::max({0.0, fronts[i].normal.dot(k.ab), fronts[i].normal.dot(k.ac)});
      in_reach = highest > coplanar_;
    }
    if (!in_reach) return;
    bool known = false;
    for (int i = 0; i < count && !known; ++i)
      known =
          (out[i].normal - plane.normal).squaredNorm() < 1e-8 && std::abs(out[i].gap - std::max(gap, 0.0)) < coplanar_;
    if (known) return;
    const Closest c = closest(p, k.a, k.ab, k.ac);
    if (c.squared >= certain * certain) return;
    const double distance = std::sqrt(c.squared);
    // The surface continues with only a small bend.
    if (plane.normal.dot(fronts[0].normal) > smooth && gap < smooth * distance) return;
    if (count < kMaxPlanes && (c.feature == Feature::face || plane.normal.dot(c.offset) > smooth * distance))
      out[count++] = {plane.normal, std::max(gap, 0.0)};
    else
      certain = distance;
  };
  const PointLanes at(p);
  for (const Candidate& candidate : list.candidates()) {
    if (certain <= 0) return 0;
    if (candidate.from_center - off >= certain) break;
    if (slabs_[candidate.slot].squared_distance(at) > TriangleSlabs::filter(certain * certain)) continue;
    meet(candidate.slot);
  }
  return certain;
}

}  // namespace dismantle::sdf
