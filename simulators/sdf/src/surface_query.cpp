#include "dismantle/sdf/surface_query.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace dismantle::sdf {
namespace {

enum class Feature : std::uint8_t { face, edge0, edge1, edge2, corner0, corner1, corner2 };

struct Closest {
  Eigen::Vector3d offset;  ///< p minus the closest point
  double squared;
  Feature feature;
};

/// Closest point of triangle a, a + ab, a + ac to p (Ericson, Real-Time Collision Detection, 5.1.5).
inline Closest closest(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& ab,
                       const Eigen::Vector3d& ac) {
  const Eigen::Vector3d ap = p - a;
  const auto done = [](const Eigen::Vector3d& offset, Feature f) { return Closest{offset, offset.squaredNorm(), f}; };
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return done(ap, Feature::corner0);
  const Eigen::Vector3d bp = ap - ab;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return done(bp, Feature::corner1);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return done(ap - d1 / (d1 - d3) * ab, Feature::edge0);
  const Eigen::Vector3d cp = ap - ac;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return done(cp, Feature::corner2);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return done(ap - d2 / (d2 - d6) * ac, Feature::edge2);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return done(bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (ac - ab), Feature::edge1);
  const double inv = 1.0 / (va + vb + vc);
  return done(ap - (vb * inv) * ab - (vc * inv) * ac, Feature::face);
}

float below(double x) { return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity()); }
float above(double x) { return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity()); }

constexpr std::uint32_t kLeafSize = 4;

/// Cells of the candidate lists, assembly units: a few steps of motion, a few triangles.
constexpr double kCell = 0.05, kLeastCell = 0.01, kCellsPerEdge = 24;
/// Lists serve points that are nearer than this to the surface.
constexpr double kNearSurface = 0.12;
/// More candidates than this are better looked for in the tree. Few of a long list are looked at: it is sorted.
constexpr std::size_t kMostCandidates = 256;
/// Rounding of distances and of their storage as float, for coordinates of up to some tens.
constexpr double kRounding = 1e-5;
/// Nobody stays linear for longer than this.
constexpr double kMostFlat = 0.1;
/// Corners that are less than this off a plane lie in it: what single precision leaves of a flat face.
constexpr double kCoplanar = 2e-6;

}  // namespace

SurfaceQuery::SurfaceQuery(const Solid& solid)
    : indices_(solid.mesh.triangles), face_(solid.face_normal), vertex_(solid.vertex_normal), edge_(solid.edge_normal) {
  const auto n = static_cast<std::uint32_t>(solid.mesh.triangles.size());
  std::vector<Aabb> boxes(n);
  for (std::uint32_t t = 0; t < n; ++t)
    for (int k = 0; k < 3; ++k) boxes[t].extend(solid.mesh.vertex(t, k));
  std::vector<std::uint32_t> ids(n);
  std::iota(ids.begin(), ids.end(), 0u);
  nodes_.reserve(n);
  if (n > 0) build(0, n, ids, boxes);
  triangle_ = ids;
  slot_.resize(n);
  corners_.resize(n);
  for (std::uint32_t s = 0; s < n; ++s) {
    slot_[ids[s]] = s;
    const auto &a = solid.mesh.vertex(ids[s], 0), &b = solid.mesh.vertex(ids[s], 1), &c = solid.mesh.vertex(ids[s], 2);
    corners_[s] = {a, b - a, c - a};
  }
  find_faces(solid);
  find_convex_features(solid);
  Aabb box = solid.mesh.box();
  if (n == 0) return;
  const double cell = std::clamp(box.size().maxCoeff() / kCellsPerEdge, kLeastCell, kCell);
  box.inflate(kNearSurface);
  cells_ = std::make_unique<CandidateCells>(box, cell);
}

/// The triangle closest to a point of the cell is no further from the centre than the centre's own closest triangle
/// and twice the half diagonal.
CandidateList SurfaceQuery::candidates_of(const Eigen::Vector3d& center) const {
  CandidateList list;
  list.center = center;
  const Sample closest_to_center = sample(center);
  const double reach = std::abs(closest_to_center.value) + 2 * cells_->half_diagonal() + kRounding;
  list.reach = reach - kRounding;
  std::vector<std::uint32_t> todo{0};
  while (!todo.empty()) {
    const std::uint32_t id = todo.back();
    const Node& n = nodes_[id];
    todo.pop_back();
    double outside = 0;
    for (int k = 0; k < 3; ++k) {
      const double d = std::max({n.lo[k] - center[k], center[k] - n.hi[k], 0.0});
      outside += d * d;
    }
    if (outside > reach * reach) continue;
    if (n.count == 0) {
      todo.push_back(n.first);
      todo.push_back(id + 1);
      continue;
    }
    for (std::uint32_t s = n.first; s < n.first + n.count; ++s) {
      const double d = std::sqrt(closest(center, corners_[s].a, corners_[s].ab, corners_[s].ac).squared);
      if (d > reach) continue;
      if (list.candidates.size() == kMostCandidates) {
        list.candidates.clear();
        list.candidates.shrink_to_fit();
        list.usable = false;
        return list;
      }
      Candidate candidate{static_cast<float>(d - kRounding), s, {}, {}};
      const Corner& c = corners_[s];
      for (int k = 0; k < 3; ++k) {
        const double b = c.a[k] + c.ab[k], e = c.a[k] + c.ac[k];
        candidate.lo[k] = below(std::min({c.a[k], b, e}));
        candidate.hi[k] = above(std::max({c.a[k], b, e}));
      }
      list.candidates.push_back(candidate);
    }
  }
  std::sort(list.candidates.begin(), list.candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.from_center != b.from_center ? a.from_center < b.from_center : a.slot < b.slot;
  });
  return list;
}

void SurfaceQuery::find_faces(const Solid& solid) {
  const Mesh& mesh = solid.mesh;
  const auto n = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<std::vector<std::uint32_t>> around(mesh.vertices.size());
  for (std::uint32_t t = 0; t < n; ++t)
    for (const std::uint32_t v : mesh.triangles[t]) around[v].push_back(t);
  face_of_.assign(n, kNoTriangle);
  std::vector<std::uint32_t> todo;
  for (std::uint32_t seed = 0; seed < n; ++seed) {
    if (face_of_[seed] != kNoTriangle) continue;
    const auto id = static_cast<std::uint32_t>(planes_.size());
    const Plane plane{face_[seed], face_[seed].dot(mesh.vertex(seed, 0))};
    planes_.push_back(plane);
    face_of_[seed] = id;
    todo.assign(1, seed);
    while (!todo.empty()) {
      const std::uint32_t t = todo.back();
      todo.pop_back();
      for (const std::uint32_t v : mesh.triangles[t])
        for (const std::uint32_t u : around[v]) {
          if (face_of_[u] != kNoTriangle || face_[u].dot(plane.normal) < 0.5) continue;
          bool flat = true;
          for (int k = 0; k < 3 && flat; ++k)
            flat = std::abs(plane.normal.dot(mesh.vertex(u, k)) - plane.offset) <= kCoplanar;
          if (!flat) continue;
          face_of_[u] = id;
          todo.push_back(u);
        }
    }
  }
}

void SurfaceQuery::find_convex_features(const Solid& solid) {
  constexpr double kFlat = 1e-6;
  const Mesh& mesh = solid.mesh;
  const auto n = static_cast<std::uint32_t>(mesh.triangles.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, std::size_t>> open;
  neighbor_.assign(n, {kNoTriangle, kNoTriangle, kNoTriangle});
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
      // Positive where the surface bends away from the viewer outside.
      const double bend = face_[t].cross(face_[u]).dot(along);
      if (bend > kFlat || (std::abs(bend) <= kFlat && face_[t].dot(face_[u]) < 0)) {
        neighbor_[t][k] = u;
        neighbor_[u][j] = t;
      } else if (bend < -kFlat) {
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
  const Closest closest_point = closest(p, c.a, c.ab, c.ac);
  const auto f = static_cast<std::size_t>(closest_point.feature);
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
  const Eigen::Vector3d q = p - closest_point.offset;
  for (std::size_t k = 0; k < 3; ++k) {
    if (neighbor_[t][k] == kNoTriangle) continue;
    const Eigen::Vector3d along = corner[(k + 1) % 3] - corner[k];
    const bool on_edge = f == k + 1;
    if (!on_edge && (q - corner[k]).cross(along).squaredNorm() > near * near * along.squaredNorm()) continue;
    add(t, corner[k]);
    add(neighbor_[t][k], corner[k]);
  }
  return count > 1 ? count : 0;
}

double SurfaceQuery::surroundings(const Eigen::Vector3d& p, const FacePlane* fronts, int front_count, double reach,
                                  FacePlane* out, int& count) const {
  // A point this far behind a face is still taken to be in front of it; a corner this far in front of one sticks out.
  constexpr double kBehind = 2e-4, kSticksOut = 1e-6;
  constexpr double kSmooth = 0.87, kBeside = 0.6, kFacing = 0.87;
  if (!cells_ || !cells_->covers(p)) return 0;
  const CandidateList& list = cells_->at(p, [this](const Eigen::Vector3d& center) { return candidates_of(center); });
  if (!list.usable) return 0;
  const double off = (p - list.center).norm();
  double certain = std::min(reach, list.reach - off);
  for (const Candidate& candidate : list.candidates) {
    if (certain <= 0) return 0;
    if (candidate.from_center - off >= certain) break;
    if (candidate.squared_distance(p) >= certain * certain) continue;
    const Plane& plane = planes_[face_of_[triangle_[candidate.slot]]];
    const double gap = plane.normal.dot(p) - plane.offset;
    if (gap < -kBehind || gap >= certain) continue;
    // What lies behind all fronts is out of reach.
    const Corner& k = corners_[candidate.slot];
    bool in_reach = false;
    for (int i = 0; i < front_count && !in_reach; ++i) {
      const double here = fronts[i].gap + fronts[i].normal.dot(k.a - p);
      const double highest = here + std::max({0.0, fronts[i].normal.dot(k.ab), fronts[i].normal.dot(k.ac)});
      in_reach = highest > kSticksOut;
    }
    if (!in_reach) continue;
    bool known = false;
    for (int i = 0; i < count && !known; ++i)
      known = (out[i].normal - plane.normal).squaredNorm() < 1e-8 && std::abs(out[i].gap - std::max(gap, 0.0)) < 1e-6;
    if (known) continue;
    const Closest c = closest(p, k.a, k.ab, k.ac);
    if (c.squared >= certain * certain) continue;
    const double distance = std::sqrt(c.squared);
    // Where the surface goes on, only a little bent.
    if (plane.normal.dot(fronts[0].normal) > kSmooth && gap < kBeside * distance) continue;
    if (count < kMaxPlanes && (c.feature == Feature::face || plane.normal.dot(c.offset) > kFacing * distance))
      out[count++] = {plane.normal, std::max(gap, 0.0)};
    else
      certain = distance;
  }
  return certain;
}

void SurfaceQuery::build(std::uint32_t first, std::uint32_t count, std::vector<std::uint32_t>& ids,
                         const std::vector<Aabb>& boxes) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  Aabb box, centers;
  for (std::uint32_t i = first; i < first + count; ++i) {
    box.extend(boxes[ids[i]]);
    centers.extend(boxes[ids[i]].center());
  }
  for (int k = 0; k < 3; ++k) {
    nodes_[self].lo[k] = below(box.lo[k]);
    nodes_[self].hi[k] = above(box.hi[k]);
  }
  if (count <= kLeafSize) {
    nodes_[self].first = first;
    nodes_[self].count = count;
    return;
  }
  Eigen::Index axis = 0;
  centers.size().maxCoeff(&axis);
  const std::uint32_t half = count / 2;
  const auto begin = ids.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t x, std::uint32_t y) {
    const double cx = boxes[x].lo[axis] + boxes[x].hi[axis], cy = boxes[y].lo[axis] + boxes[y].hi[axis];
    return cx != cy ? cx < cy : x < y;
  });
  nodes_[self].count = 0;
  build(first, half, ids, boxes);
  nodes_[self].first = static_cast<std::uint32_t>(nodes_.size());
  build(first + half, count - half, ids, boxes);
}

Sample SurfaceQuery::signed_sample(const Eigen::Vector3d& p, std::uint32_t slot) const {
  const Closest c = closest(p, corners_[slot].a, corners_[slot].ab, corners_[slot].ac);
  const std::uint32_t t = triangle_[slot];
  const auto f = static_cast<std::size_t>(c.feature);
  const Eigen::Vector3d& pseudo = f == 0 ? face_[t] : f <= 3 ? edge_[t][f - 1] : vertex_[indices_[t][f - 4]];
  Sample s;
  s.triangle = t;
  const double distance = std::sqrt(c.squared);
  const bool inside = c.offset.dot(pseudo) < 0;
  s.value = inside ? -distance : distance;
  // On a face the normal is known better than p - q tells; on the surface itself p - q says nothing.
  if (f == 0) {
    s.normal = planes_[face_of_[t]].normal;
    s.value = plane_distance(p, t);
  } else if (distance > 1e-9)
    s.normal = (inside ? -1.0 : 1.0) / distance * c.offset;
  else
    s.normal = pseudo.stableNormalized();
  return s;
}

/// Where the closest point lies inside a face, it stays in the plane of that face until another one comes as near: not
/// before the point has gone half of the difference between the two distances.
double SurfaceQuery::flat_radius(const Eigen::Vector3d& p, const Sample& sample, const CandidateList& list,
                                 double from_edge) const {
  const std::uint32_t slot = slot_[sample.triangle];
  const Corner& own = corners_[slot];
  if (closest(p, own.a, own.ab, own.ac).feature != Feature::face) return 0;
  const double distance = std::abs(sample.value), off = (p - list.center).norm();
  const auto alone = [&](double other) { return 0.5 * (other - distance) - from_edge; };
  double radius = std::min(kMostFlat, alone(list.reach - off));
  for (const Candidate& candidate : list.candidates) {
    if (radius <= 0) return 0;
    if (alone(candidate.from_center - off) >= radius) break;
    if (candidate.slot == slot) continue;
    const double limit = distance + 2 * (radius + from_edge);
    if (candidate.squared_distance(p) >= limit * limit) continue;
    const Corner& k = corners_[candidate.slot];
    if (face_of_[triangle_[candidate.slot]] == face_of_[sample.triangle]) continue;
    radius = std::min(radius, alone(std::sqrt(closest(p, k.a, k.ab, k.ac).squared)));
  }
  return std::max(radius, 0.0);
}

Sample SurfaceQuery::sample(const Eigen::Vector3d& p, double limit, std::uint32_t hint,
                            const FlatnessWanted& flatness) const {
  if (nodes_.empty()) return {};
  double best = limit * limit;
  std::uint32_t best_slot = kNoTriangle;
  if (hint < slot_.size()) {
    const std::uint32_t s = slot_[hint];
    const Closest c = closest(p, corners_[s].a, corners_[s].ab, corners_[s].ac);
    if (c.squared < best) {
      best = c.squared;
      best_slot = s;
    }
  }
  // The hint may tie with another triangle: keep a strict order so that the answer does not depend on it.
  if (best_slot != kNoTriangle && best < kNearSurface * kNearSurface && cells_->covers(p)) {
    const CandidateList& list = cells_->at(p, [this](const Eigen::Vector3d& center) { return candidates_of(center); });
    if (list.usable) {
      const double off = (p - list.center).norm();
      for (const Candidate& candidate : list.candidates) {
        const double least = candidate.from_center - off;
        if (least > 0 && least * least > best) break;
        if (candidate.squared_distance(p) > best) continue;
        const Corner& k = corners_[candidate.slot];
        const Closest c = closest(p, k.a, k.ab, k.ac);
        if (c.squared < best || (c.squared == best && candidate.slot < best_slot)) {
          best = c.squared;
          best_slot = candidate.slot;
        }
      }
      Sample s = signed_sample(p, best_slot);
      if (std::abs(s.value) < flatness.within) s.flat_radius = flat_radius(p, s, list, flatness.from_edge);
      return s;
    }
  }
  const double px = p.x(), py = p.y(), pz = p.z();
  const auto box_distance = [&](const Node& n) {
    const double dx = std::max({n.lo[0] - px, px - n.hi[0], 0.0});
    const double dy = std::max({n.lo[1] - py, py - n.hi[1], 0.0});
    const double dz = std::max({n.lo[2] - pz, pz - n.hi[2], 0.0});
    return dx * dx + dy * dy + dz * dz;
  };
  struct Entry {
    std::uint32_t node;
    double squared;
  };
  Entry stack[64];
  int top = 0;
  std::uint32_t node = 0;
  double here = box_distance(nodes_[0]);
  while (true) {
    if (here <= best) {
      const Node& n = nodes_[node];
      if (n.count > 0) {
        for (std::uint32_t s = n.first; s < n.first + n.count; ++s) {
          const Closest c = closest(p, corners_[s].a, corners_[s].ab, corners_[s].ac);
          if (c.squared < best || (c.squared == best && s < best_slot && best_slot != kNoTriangle)) {
            best = c.squared;
            best_slot = s;
          }
        }
      } else {
        std::uint32_t near = node + 1, far = n.first;
        double dn = box_distance(nodes_[near]), df = box_distance(nodes_[far]);
        if (df < dn) {
          std::swap(near, far);
          std::swap(dn, df);
        }
        if (df <= best) stack[top++] = {far, df};
        node = near;
        here = dn;
        continue;
      }
    }
    if (top == 0) break;
    --top;
    node = stack[top].node;
    here = stack[top].squared;
  }
  if (best_slot == kNoTriangle) return {};
  return signed_sample(p, best_slot);
}

}  // namespace dismantle::sdf
