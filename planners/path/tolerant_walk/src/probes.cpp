#include "dismantle/tolerant_walk/probes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/inner_ball.h"

namespace dismantle::tolerant_walk {
namespace {

using Vec3 = Eigen::Vector3d;

/// Share of a wall's thickness that the verifier allows to be penetrated.
constexpr double kWallShare = 0.25;
/// Maximum number of samples along an edge of a triangle; bounds time and memory.
constexpr int kMaxPerEdge = 300;
/// Maximum number of candidates measured per kept sample. Fine meshes have many more.
constexpr int kTriesPerCell = 4;

/// Distance from a point of the surface to the opposite side, by sphere tracing in the field; at most `limit`.
double thickness_at(DistanceField& part, const Vec3& p, const Vec3& inward, double limit) {
  const double step = part.resolution().ray_step();
  for (double s = step; s < limit;) {
    const double depth = -part.at(p + s * inward);
    if (depth < part.resolution().on_surface() && s > 2 * step) {
      // Only a surface that faces the ray counts, not one that the ray passes beside.
      const auto& c = part.bvh().corners(part.bvh().closest(p + s * inward).triangle);
      const Vec3 out = geometry::area_vector(c);
      if (out.dot(inward) > 0.5 * out.norm()) return s;
    }
    s += std::max(depth, step);
  }
  return limit;
}

/// Share of a triangle's bounding box that is within the region.
double share_within(const std::array<Vec3, 3>& corners, const Aabb& region) {
  Aabb box;
  for (const auto& v : corners) box.extend(v);
  double share = 1;
  for (int k = 0; k < 3; ++k) {
    const double size = box.hi[k] - box.lo[k];
    if (size > 1e-12)
      share *= std::clamp((std::min(box.hi[k], region.hi[k]) - std::max(box.lo[k], region.lo[k])) / size, 0.0, 1.0);
  }
  return share;
}

}  // namespace

Probes::Probes(DistanceField& part, const Allowance& allowance, const Aabb& region, std::size_t max_count,
               const std::function<bool(const Vec3&)>& wanted) {
  const double allowed = allowance.overlap + allowance.tolerance;
  const TriangleBvh& bvh = part.bvh();
  double area = 0;
  bvh.overlapping(region, [&](std::uint32_t t) {
    area += 0.5 * geometry::area_vector(bvh.corners(t)).norm() * share_within(bvh.corners(t), region);
  });
  if (!(area > 0)) return;
  const Resolution& resolution = part.resolution();
  const double spacing = std::max(resolution.sample_spacing(), std::sqrt(area / static_cast<double>(max_count)));
  const double cell = 0.7 * spacing;  // each cell keeps its strictest sample
  using Key = std::tuple<long, long, long>;
  const auto key_of = [cell](const Vec3& p) {
    return Key(std::lround(p.x() / cell), std::lround(p.y() / cell), std::lround(p.z() / cell));
  };
  std::map<Key, Probe> balls, points;
  std::map<Key, int> ball_tries, point_tries;  // by cell of the point on the surface
  const auto normal_of = [&](std::uint32_t t) {
    const Vec3 n = geometry::area_vector(bvh.corners(t));
    return n.norm() > 0 ? Vec3(n.normalized()) : Vec3(Vec3::Zero());
  };
  // The deepest point of a pair lies on an edge of one of the two.
  const auto sample_edge = [&](const Vec3& a, const Vec3& b, const Vec3& normal, const Vec3& beside) {
    const int n = std::clamp(static_cast<int>(std::ceil((b - a).norm() / spacing)), 1, kMaxPerEdge);
    for (int i = 0; i <= n; ++i) {
      const Vec3 p = a + static_cast<double>(i) / n * (b - a);
      if (!region.contains(p) || !wanted(p) || ++point_tries[key_of(p)] > kTriesPerCell) continue;
      const double thick = allowance.tolerance / kWallShare;
      const double thin = std::min(thickness_at(part, p - resolution.ray_step() * beside, -normal, thick),
                                   thickness_at(part, p - resolution.ray_step() * normal, -beside, thick));
      const Probe probe{p, -allowance.overlap - std::min(allowance.tolerance, kWallShare * thin)};
      const auto [entry, is_new] = points.try_emplace(key_of(p), probe);
      if (!is_new && probe.keep > entry->second.keep) entry->second = probe;
    }
  };
  const auto sample_ball = [&](const Vec3& p, const Vec3& inward) {
    if (!region.contains(p) || !wanted(p) || ++ball_tries[key_of(p)] > kTriesPerCell) return;
    const double radius = inner_ball_radius(bvh, p, inward, resolution.thin_radius());
    if (!(radius > allowed) || !(radius < resolution.thin_radius())) return;
    const Probe ball{p + radius * inward, radius - allowed};
    Probe& best = balls[key_of(ball.center)];
    if (ball.keep > best.keep) best = ball;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> open;  // edges with one visited triangle
  bvh.overlapping(region, [&](std::uint32_t t) {
    const auto& c = bvh.corners(t);
    const Vec3 normal = normal_of(t);
    if (normal.isZero()) return;
    const Triangle& v = part.mesh().triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto met = open.find(std::minmax(v[k], v[(k + 1) % 3]));
      if (met == open.end()) {
        open.emplace(std::minmax(v[k], v[(k + 1) % 3]), t);
        continue;
      }
      const Vec3 beside = normal_of(met->second);
      // Faces that are parallel to within 3 degrees have no edge between them.
      if (normal.dot(beside) < 0.9986) sample_edge(c[k], c[(k + 1) % 3], normal, beside);
      open.erase(met);
    }
    const double edge = std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
    const int n = std::clamp(static_cast<int>(std::ceil(edge / spacing)), 1, kMaxPerEdge);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n - i; ++j)
        for (int half = 0; half < (i + j < n - 1 ? 2 : 1); ++half)  // centres of the small triangles
          sample_ball(c[0] + (i + (half + 1) / 3.0) / n * (c[1] - c[0]) + (j + (half + 1) / 3.0) / n * (c[2] - c[0]),
                      -normal);
  });
  for (const auto* kind : {&balls, &points})
    for (const auto& [key, probe] : *kind) probes_.push_back(probe);
  if (!probes_.empty()) build(0, static_cast<std::uint32_t>(probes_.size()));
}

void Probes::build(std::uint32_t first, std::uint32_t count) {
  const std::size_t id = nodes_.size();
  nodes_.emplace_back();
  Node node;
  Aabb box;
  node.keep = probes_[first].keep;
  for (std::uint32_t k = first; k < first + count; ++k) {
    box.extend(probes_[k].center);
    node.keep = std::max(node.keep, probes_[k].keep);
  }
  node.center = box.center();
  for (std::uint32_t k = first; k < first + count; ++k)
    node.radius = std::max(node.radius, (probes_[k].center - node.center).norm());
  node.first = first;
  node.count = count;
  if (count > 4) {
    int axis = 0;
    box.size().maxCoeff(&axis);
    const auto begin = probes_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count,
                     [axis](const Probe& a, const Probe& b) { return a.center[axis] < b.center[axis]; });
    node.count = 0;
    build(first, count / 2);
    node.first = static_cast<std::uint32_t>(nodes_.size());
    build(first + count / 2, count - count / 2);
  }
  nodes_[id] = node;
}

void Probes::merge(Probes other) {
  probes_.insert(probes_.end(), other.probes_.begin(), other.probes_.end());
  added_.insert(added_.end(), other.added_.begin(), other.added_.end());
  nodes_.clear();
  if (!probes_.empty()) build(0, static_cast<std::uint32_t>(probes_.size()));
}

std::size_t Probes::bytes() const { return size() * sizeof(Probe) + nodes_.size() * sizeof(Node); }

bool Probes::any_violated(const Pose& place, DistanceField& other) {
  const Eigen::Matrix3d r = place.q.toRotationMatrix();
  const auto violated = [&](const Probe& p) { return other.at(r * p.center + place.t) < p.keep; };
  if (std::any_of(added_.begin(), added_.end(), violated)) return true;
  if (nodes_.empty()) return false;
  if (violated(probes_[last_])) return true;  // the same probe is often violated again
  struct OpenNode {
    std::uint32_t node;
    double bound;  // upper bound of the violation of its probes
  };
  const auto visit = [&](std::uint32_t id) {
    const Node& node = nodes_[id];
    return OpenNode{id, node.keep + node.radius - other.at(r * node.center + place.t)};
  };
  std::array<OpenNode, 64> open;
  std::size_t waiting = 0;
  open[waiting++] = visit(0);
  while (waiting > 0) {
    const OpenNode next = open[--waiting];
    if (!(next.bound > 0)) continue;
    const Node& node = nodes_[next.node];
    if (node.count > 0) {
      for (std::uint32_t k = node.first; k < node.first + node.count; ++k)
        if (violated(probes_[k])) {
          last_ = k;
          return true;
        }
      continue;
    }
    const OpenNode left = visit(next.node + 1), right = visit(node.first);
    const bool right_first = right.bound > left.bound;  // visits the child more likely to be violated first
    open[waiting++] = right_first ? left : right;
    open[waiting++] = right_first ? right : left;
  }
  return false;
}

}  // namespace dismantle::tolerant_walk
