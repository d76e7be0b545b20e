#include "dismantle/sdf/surface_query.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "closest_on_triangle.h"

namespace dismantle::sdf {
namespace {

float below(double x) { return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity()); }
float above(double x) { return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity()); }

constexpr std::uint32_t kLeafSize = 4;

/// Cells of the candidate lists, assembly units: a few steps of motion, a few triangles.
constexpr double kCell = 0.05, kLeastCell = 0.01, kCellsPerEdge = 24;
/// Lists serve points that are nearer than this to the surface.
constexpr double kNearSurface = 0.12;
/// More candidates than this are better looked for in the tree. Few of a long list are looked at: it is sorted.
constexpr std::size_t kMostCandidates = 256;
/// Room that a list has before it has to grow.
constexpr std::size_t kLikely = 64;
/// Rounding of distances and of their storage as float, for coordinates of up to some tens.
constexpr double kRounding = 1e-5;
/// Nobody stays linear for longer than this.
constexpr double kMostFlat = 0.1;

/// What a squared distance from a box has to exceed for the triangle to be further away than the root of `squared`.
float filter_of(double squared) { return static_cast<float>(squared * (1 + 2 * CandidateGroup::kRelative)); }

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
  boxes_.resize(n);
  for (std::uint32_t s = 0; s < n; ++s) {
    slot_[ids[s]] = s;
    const auto &a = solid.mesh.vertex(ids[s], 0), &b = solid.mesh.vertex(ids[s], 1), &c = solid.mesh.vertex(ids[s], 2);
    corners_[s] = {a, b - a, c - a};
    for (int k = 0; k < 3; ++k) {
      boxes_[s].lo[k] = below(std::min({a[k], b[k], c[k]}) - kRounding);
      boxes_[s].hi[k] = above(std::max({a[k], b[k], c[k]}) + kRounding);
    }
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
CandidateDraft SurfaceQuery::candidates_of(const Eigen::Vector3d& center) const {
  CandidateDraft list;
  list.center = center;
  const Sample closest_to_center = sample(center);
  const double reach = std::abs(closest_to_center.value) + 2 * cells_->half_diagonal() + kRounding;
  list.reach = reach - kRounding;
  list.candidates.reserve(kLikely);
  std::array<std::uint32_t, 64> todo;  // the tree is balanced: no deeper than the bits of a number
  std::size_t left = 0;
  todo[left++] = 0;
  while (left > 0) {
    const std::uint32_t id = todo[--left];
    const Node& n = nodes_[id];
    double outside = 0;
    for (int k = 0; k < 3; ++k) {
      const double d = std::max({n.lo[k] - center[k], center[k] - n.hi[k], 0.0});
      outside += d * d;
    }
    if (outside > reach * reach) continue;
    if (n.count == 0) {
      todo[left++] = n.first;
      todo[left++] = id + 1;
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
      list.candidates.push_back({static_cast<float>(d - kRounding), s, boxes_[s]});
    }
  }
  std::sort(list.candidates.begin(), list.candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.from_center != b.from_center ? a.from_center < b.from_center : a.slot < b.slot;
  });
  return list;
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
  const Eigen::Vector3f at = p.cast<float>();
  for (const CandidateGroup& group : list.groups()) {
    if (radius <= 0) return 0;
    if (alone(group.from_center[0] - off) >= radius) break;
    const CandidateGroup::Floats squared = group.squared_distances(at);
    for (int i = 0; i < CandidateGroup::kSize; ++i) {
      const double limit = distance + 2 * (radius + from_edge);
      if (squared[i] > filter_of(limit * limit)) continue;
      const std::uint32_t other = group.slot[i];
      if (other == slot || face_of_[triangle_[other]] == face_of_[sample.triangle]) continue;
      const Corner& k = corners_[other];
      radius = std::min(radius, alone(std::sqrt(closest(p, k.a, k.ab, k.ac).squared)));
      if (radius <= 0) return 0;
    }
  }
  return std::max(radius, 0.0);
}

void SurfaceQuery::prefetch(std::span<const Eigen::Vector3d> points, std::span<const std::uint32_t> hints) const {
  if (!cells_) return;
  std::array<const CandidateCells::Place*, kMostPrefetched> places;
  for (std::size_t i = 0; i < points.size(); ++i) {
    places[i] = cells_->prefetch_place(points[i]);
    if (hints[i] < slot_.size()) __builtin_prefetch(&corners_[slot_[hints[i]]]);
  }
  for (std::size_t i = 0; i < points.size(); ++i) CandidateCells::prefetch_list(places[i]);
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
      const Eigen::Vector3f at = p.cast<float>();
      for (const CandidateGroup& group : list.groups()) {
        const double least = group.from_center[0] - off;
        if (least > 0 && least * least > best) break;
        const CandidateGroup::Floats squared = group.squared_distances(at);
        if ((squared > filter_of(best)).all()) continue;
        for (int i = 0; i < CandidateGroup::kSize; ++i) {
          if (squared[i] > filter_of(best)) continue;
          const std::uint32_t slot = group.slot[i];
          const Corner& k = corners_[slot];
          const Closest c = closest(p, k.a, k.ab, k.ac);
          if (c.squared < best || (c.squared == best && slot < best_slot)) {
            best = c.squared;
            best_slot = slot;
          }
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
