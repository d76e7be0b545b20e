#include "dismantle/sdf/surface_query.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dismantle::sdf {
namespace {

float below(double x) { return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity()); }
float above(double x) { return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity()); }

}  // namespace

SurfaceQuery::SurfaceQuery(const Solid& solid, const geometry::Poll& poll)
    : indices_(solid.mesh.triangles), face_(solid.face_normal), vertex_(solid.vertex_normal), edge_(solid.edge_normal) {
  const auto n = static_cast<std::uint32_t>(solid.mesh.triangles.size());
  std::vector<Aabb> boxes(n);
  for (std::uint32_t t = 0; t < n; ++t)
    for (int k = 0; k < 3; ++k) boxes[t].extend(solid.mesh.vertex(t, k));
  std::vector<std::uint32_t> ids(n);
  std::iota(ids.begin(), ids.end(), 0u);
  nodes_.reserve(n);
  if (n > 0) build(0, n, ids, boxes, poll);
  triangle_ = ids;
  slot_.resize(n);
  corners_.resize(n);
  slabs_.reserve(n);
  Aabb reach = solid.mesh.box();
  coplanar_ = std::numeric_limits<float>::epsilon() * reach.size().norm();
  reach.inflate(kNear);
  bounded_within_ = 2 * reach.lo.cwiseAbs().cwiseMax(reach.hi.cwiseAbs()).norm();
  for (std::uint32_t s = 0; s < n; ++s) {
    poll.in_pass(s);
    slot_[ids[s]] = s;
    const auto &a = solid.mesh.vertex(ids[s], 0), &b = solid.mesh.vertex(ids[s], 1), &c = solid.mesh.vertex(ids[s], 2);
    corners_[s] = {a, b - a, c - a};
    slabs_.emplace_back(a, b - a, c - a, bounded_within_);
  }
  if (solid.open) walls_ = std::make_unique<WallSides>(solid.mesh, poll);
  find_faces(solid);
  poll.before(n);
  find_convex_features(solid);
  if (n == 0) return;
  // 24 cells along the longest edge of the part, or of the region around a small part: more cells cost memory and save
  // little time.
  const double cell = std::clamp(solid.mesh.box().size().maxCoeff() / 24, 2 * kNear / 24, 0.5 * kNear);
  cells_ = std::make_unique<CandidateCells>(reach, cell);
}

/// Ties go to the first triangle, so that the answer does not depend on where the search began.
inline void SurfaceQuery::update_nearest(const Eigen::Vector3d& p, std::uint32_t slot, Nearest& nearest) const {
  const Corner& k = corners_[slot];
  const Closest c = closest(p, k.a, k.ab, k.ac);
  if (c.squared < nearest.squared ||
      (c.squared == nearest.squared && nearest.slot != geometry::kNoIndex && slot < nearest.slot))
    nearest = {c.squared, slot, c};
}

/// The triangle closest to a point of the cell is at most the centre's own distance plus a full diagonal from the
/// centre.
CandidateDraft SurfaceQuery::candidates_of(const Eigen::Vector3d& center, std::uint32_t near_slot) const {
  CandidateDraft list;
  list.center = center;
  Nearest nearest{std::numeric_limits<double>::infinity()};
  update_nearest(center, near_slot, nearest);
  search_tree(center, nearest);
  list.distance = signed_sample(center, nearest).value;
  const double reach = std::sqrt(nearest.squared) + 2 * cells_->half_diagonal();
  list.reach = reach;
  // No point of the cell is near the surface.
  list.usable = std::abs(list.distance) <= kNear + cells_->half_diagonal();
  if (!list.usable) return list;
  const PointLanes at(center);
  const float filter = TriangleSlabs::filter(reach * reach);
  std::array<std::uint32_t, 64> pending;  // the tree is balanced: its depth is at most the bits of an index
  std::size_t left = 0;
  pending[left++] = 0;
  while (left > 0) {
    const std::uint32_t id = pending[--left];
    const Node& n = nodes_[id];
    double outside = 0;
    for (int k = 0; k < 3; ++k) {
      const double d = std::max({n.lo[k] - center[k], center[k] - n.hi[k], 0.0});
      outside += d * d;
    }
    if (outside > reach * reach) continue;
    if (n.count == 0) {
      pending[left++] = n.first;
      pending[left++] = id + 1;
      continue;
    }
    for (std::uint32_t s = n.first; s < n.first + n.count; ++s) {
      const float squared = slabs_[s].squared_distance(at);
      if (squared > filter) continue;
      if (list.candidates.size() == 256) {  // above that the tree is faster, although few of a sorted list are examined
        list.candidates.clear();
        list.candidates.shrink_to_fit();
        list.usable = false;
        return list;
      }
      list.candidates.push_back({std::sqrt(squared * static_cast<float>(1 - TriangleSlabs::kRelative)), s});
    }
  }
  std::sort(list.candidates.begin(), list.candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.from_center != b.from_center ? a.from_center < b.from_center : a.slot < b.slot;
  });
  return list;
}

void SurfaceQuery::build(std::uint32_t first, std::uint32_t count, std::vector<std::uint32_t>& ids,
                         const std::vector<Aabb>& boxes, const geometry::Poll& poll) {
  poll.before(count);
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
  if (count <= 4) {  // a leaf: testing so few triangles costs no more than two boxes
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
  build(first, half, ids, boxes, poll);
  nodes_[self].first = static_cast<std::uint32_t>(nodes_.size());
  build(first + half, count - half, ids, boxes, poll);
}

Sample SurfaceQuery::signed_sample(const Eigen::Vector3d& p, const Nearest& nearest) const {
  const Closest& c = nearest.closest;
  const std::uint32_t t = triangle_[nearest.slot];
  Sample s;
  s.triangle = t;
  s.offset = c.offset;
  s.feature = c.feature;
  if (walls_) return wall_sample(p, s, std::sqrt(c.squared));
  // On a face the plane normal is more accurate than p - q, which is undefined on the surface itself.
  if (c.feature == Feature::face) {
    const Plane& plane = planes_[face_of_[t]];
    s.normal = plane.normal;
    s.value = plane_distance(p, t);
    return s;
  }
  const auto f = static_cast<std::size_t>(c.feature);
  const Eigen::Vector3d& pseudo = f <= 3 ? edge_[t][f - 1] : vertex_[indices_[t][f - 4]];
  const double distance = std::sqrt(c.squared);
  const bool inside = c.offset.dot(pseudo) < 0;
  s.value = inside ? -distance : distance;
  if (distance > geometry::kRounding)
    s.normal = (inside ? -1.0 : 1.0) / distance * c.offset;
  else
    s.normal = pseudo.stableNormalized();
  return s;
}

/// `s` has the closest point.
Sample SurfaceQuery::wall_sample(const Eigen::Vector3d& p, Sample s, double distance) const {
  const double side = walls_->inside(p) ? -1 : 1;
  s.value = side * distance;
  s.normal = distance > geometry::kRounding ? Eigen::Vector3d(side / distance * s.offset) : face_[s.triangle];
  return s;
}

/// A closest point inside a face stays in the plane of that face until another face is as near, which takes a motion of
/// at least half the difference of the two distances.
double SurfaceQuery::flat_radius(const Eigen::Vector3d& p, const Sample& sample, const CandidateList& list,
                                 const FlatnessWanted& wanted) const {
  if (sample.feature != Feature::face || walls_) return 0;
  const double distance = std::abs(sample.value), off = (p - list.center).norm();
  const auto alone = [&](double other) { return 0.5 * (other - distance) - wanted.from_edge; };
  double radius = std::min(kNear, alone(list.reach - off));
  double limit = distance + 2 * (radius + wanted.from_edge);
  const PointLanes at(p);
  const std::uint32_t own = face_of_[sample.triangle];
  for (const Candidate& candidate : list.candidates()) {
    if (radius <= wanted.least) return 0;
    if (candidate.from_center - off >= limit) break;
    const float squared = slabs_[candidate.slot].squared_distance(at);
    if (squared > TriangleSlabs::filter(limit * limit) || face_of_[triangle_[candidate.slot]] == own) continue;
    radius = std::min(radius, alone(std::sqrt(squared * (1 - TriangleSlabs::kRelative))));
    limit = distance + 2 * (radius + wanted.from_edge);
  }
  return radius > wanted.least ? radius : 0.0;
}

void SurfaceQuery::prefetch(std::span<const Eigen::Vector3d> points, std::span<const std::uint32_t> hints,
                            std::span<const CandidateList*> lists) const {
  std::array<const CandidateCells::Place*, kMostPrefetched> places;
  for (std::size_t i = 0; i < points.size(); ++i) {
    places[i] = cells_ ? cells_->place_of(points[i]) : nullptr;
    if (places[i] != nullptr) __builtin_prefetch(places[i]);
    if (hints[i] < slot_.size()) __builtin_prefetch(&corners_[slot_[hints[i]]]);
  }
  for (std::size_t i = 0; i < points.size(); ++i) lists[i] = CandidateCells::prefetch_list(places[i]);
}

void SurfaceQuery::look_in_list(const Eigen::Vector3d& p, const CandidateList& list, Nearest& nearest) const {
  const double off = (p - list.center).norm();
  const PointLanes at(p);
  const std::uint32_t first = nearest.slot;
  double limit = std::sqrt(nearest.squared) + off;
  for (const Candidate& candidate : list.candidates()) {
    if (candidate.from_center > limit) break;
    if (slabs_[candidate.slot].squared_distance(at) > TriangleSlabs::filter(nearest.squared)) continue;
    if (candidate.slot == first) continue;
    update_nearest(p, candidate.slot, nearest);
    limit = std::sqrt(nearest.squared) + off;
  }
}

void SurfaceQuery::search_tree(const Eigen::Vector3d& p, Nearest& nearest) const {
  const bool bounded = p.squaredNorm() < bounded_within_ * bounded_within_;
  const PointLanes at(p);
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
    if (here <= nearest.squared) {
      const Node& n = nodes_[node];
      if (n.count > 0) {
        for (std::uint32_t s = n.first; s < n.first + n.count; ++s)
          if (!bounded || slabs_[s].squared_distance(at) <= TriangleSlabs::filter(nearest.squared))
            update_nearest(p, s, nearest);
      } else {
        std::uint32_t near = node + 1, far = n.first;
        double dn = box_distance(nodes_[near]), df = box_distance(nodes_[far]);
        if (df < dn) {
          std::swap(near, far);
          std::swap(dn, df);
        }
        if (df <= nearest.squared) stack[top++] = {far, df};
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
}

double SurfaceQuery::lower_bound(const Eigen::Vector3d& p, std::uint32_t hint, const CandidateList* list) const {
  if (!cells_ || walls_ || !cells_->covers(p)) return 0;  // the side of walls changes in their openings, too
  if (list == nullptr)
    list = &cells_->at(
        p, [&](const Eigen::Vector3d& center) { return candidates_of(center, hint < slot_.size() ? slot_[hint] : 0); });
  return list->lower_bound(p);
}

Sample SurfaceQuery::sample(const Eigen::Vector3d& p, double limit, std::uint32_t hint, const FlatnessWanted& flatness,
                            const CandidateList* list) const {
  if (nodes_.empty()) return {};
  Nearest nearest{limit * limit};
  if (hint < slot_.size()) update_nearest(p, slot_[hint], nearest);
  if (nearest.slot != geometry::kNoIndex && nearest.squared < kNear * kNear && cells_->covers(p)) {
    if (list == nullptr)
      list = &cells_->at(p, [&](const Eigen::Vector3d& center) { return candidates_of(center, nearest.slot); });
    if (list->usable) {
      look_in_list(p, *list, nearest);
      Sample s = signed_sample(p, nearest);
      if (std::abs(s.value) < flatness.within) s.flat_radius = flat_radius(p, s, *list, flatness);
      return s;
    }
  }
  search_tree(p, nearest);
  if (nearest.slot == geometry::kNoIndex) return {};
  return signed_sample(p, nearest);
}

}  // namespace dismantle::sdf
