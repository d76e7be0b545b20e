#include "dismantle/immobility/interior_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

/// Moves inwards from a point of the surface to a point at `depth`. Returns nullopt where the solid is too thin.
std::optional<Vec3> sunk(const Solid& solid, const Vec3& from, const Vec3& inward, double depth) {
  Vec3 p = from + depth * inward;
  for (int k = 0; k < 24; ++k) {  // mostly one or two are enough; in too thin a wedge the point oscillates
    const ClosestPoint c = solid.bvh.closest(p);
    if (c.distance >= depth) return solid.bvh.inside(p) ? std::optional(p) : std::nullopt;
    if (c.distance < 1e-6 * depth || !solid.bvh.inside(p)) return std::nullopt;
    p += (1.01 * depth - c.distance) / c.distance * (p - c.point);
  }
  return std::nullopt;
}

Aabb placed_box(const std::vector<Solid>& solids) {
  Aabb box;
  for (const Solid& s : solids)
    for (const Vec3& v : s.mesh.vertices) box.extend(s.frame * v);
  return box;
}

/// Area of the triangles whose boxes come within `reach` of the other part's box.
double area_near(const std::vector<Solid>& solids, Aabb other, double reach) {
  other.inflate(reach);
  double area = 0;
  for (const Solid& s : solids)
    for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
      Aabb box;
      std::array<Vec3, 3> c;
      for (std::size_t k = 0; k < 3; ++k) box.extend(c[k] = s.frame * s.mesh.vertex(t, k));
      if (box.overlaps(other)) area += 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
    }
  return area;
}

std::vector<SampledPair::Plane> planes_of(const Solid& solid) {
  std::vector<SampledPair::Plane> planes;
  for (std::uint32_t t = 0; t < solid.mesh.triangles.size(); ++t) {
    const auto& c = solid.bvh.corners(t);
    const Vec3 u = c[1] - c[0], v = c[2] - c[0], normal = u.cross(v);
    planes.push_back({normal, normal.norm(), u.norm() + v.norm()});
  }
  return planes;
}

}  // namespace

SampledPair::SampledPair(const std::vector<Solid>& a, const std::vector<Solid>& b, double depth, double spacing) {
  const Aabb box_a = placed_box(a), box_b = placed_box(b);
  center_ = box_a.center();
  for (const Solid& s : a)
    for (const Vec3& v : s.mesh.vertices) radius_ = std::max(radius_, (s.frame * v - center_).norm());
  // Samples further from the other part hardly ever get there: a tenth of the part, or some rows of samples.
  const double reach = std::max(7.5 * spacing, 0.1 * radius_);
  const auto spacing_of = [&](const std::vector<Solid>& of, const Aabb& other) {
    constexpr double kMostSamples = 6000;  // samples of a part, about; memory and time grow with their number
    return std::max(spacing, std::sqrt(area_near(of, other, reach) / kMostSamples));
  };
  const double spacing_a = spacing_of(a, box_b), spacing_b = spacing_of(b, box_a);
  const double cell = 0.5 * std::min(spacing_a, spacing_b);
  Aabb both = box_a;
  both.extend(box_b.lo);
  both.extend(box_b.hi);
  // Bound of position errors, larger than the rounding that checkers of certificates assume.
  const double rounding =
      kRounding * (both.size().norm() + std::max(both.lo.cwiseAbs().maxCoeff(), both.hi.cwiseAbs().maxCoeff()));
  for (const auto* solids : {&a, &b})
    for (const Solid& s : *solids)
      obstacles_.push_back({&s, s.frame.inverse(), s.frame.q.toRotationMatrix().transpose(),
                            Occupancy(s.bvh, s.box, cell), planes_of(s), rounding});
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k) {
      add(a[i], static_cast<std::uint32_t>(a.size() + k), true, depth, spacing_a, reach);
      add(b[k], static_cast<std::uint32_t>(i), false, depth, spacing_b, reach);
    }
  // A rotation moves samples by their distance from its axis. Typical samples are almost as far out as the furthest; a
  // long part that turns about its length moves them little. No sample is nearer than its depth, in effect.
  Vec3 furthest = Vec3::Constant(depth);
  for (const InteriorSample& p : samples_)
    for (int d = 0; d < 3; ++d) furthest[d] = std::max(furthest[d], p.at.cross(Vec3::Unit(d)).norm());
  scale_ << 0.85 * furthest, Vec3::Ones();
}

void SampledPair::add(const Solid& of, std::uint32_t obstacle, bool of_a, double depth, double spacing, double reach) {
  const Solid& other = *obstacles_[obstacle].solid;
  const Pose& to_other = obstacles_[obstacle].to_local;
  Aabb near = other.box;
  near.inflate(reach + depth);
  std::set<std::array<long, 3>> taken;
  const auto steps = [&](const Vec3& edge) { return std::max(1, static_cast<int>(std::ceil(edge.norm() / spacing))); };
  for (std::size_t t = 0; t < of.mesh.triangles.size(); ++t) {
    if (of.normals[t].isZero()) continue;
    const Vec3 o = of.mesh.vertex(t, 0), u = of.mesh.vertex(t, 1) - o, v = of.mesh.vertex(t, 2) - o;
    const int nu = steps(u), nv = steps(v);
    for (int i = 0; i <= nu; ++i)
      for (int k = 0; k <= nv; ++k) {
        const double x = static_cast<double>(i) / nu, y = static_cast<double>(k) / nv;
        if (x + y > 1 + kRounding) continue;
        const Vec3 s = o + x * u + y * v;
        if (!near.contains(to_other * (of.frame * s))) continue;
        const auto p = sunk(of, s, -of.normals[t], depth);
        if (!p) continue;
        const std::array<long, 3> cell{std::lround(p->x() / (0.5 * spacing)), std::lround(p->y() / (0.5 * spacing)),
                                       std::lround(p->z() / (0.5 * spacing))};
        if (!taken.insert(cell).second) continue;
        const Vec3 assembled = of.frame * *p, there = to_other * assembled;
        const double clearance = other.bvh.closest(there, reach).distance;
        if (clearance < reach && !other.bvh.inside(there))
          samples_.push_back({of_a, obstacle, assembled - center_, clearance});
      }
  }
}

bool all_closed(const std::vector<Solid>& solids) {
  return std::all_of(solids.begin(), solids.end(), [](const Solid& s) { return edge_use(s.mesh).closed(); });
}

RelativePose::RelativePose(const SampledPair& pair, const Vector6& x)
    : pair_(&pair), rotation_(rotation_from_vector(x.head<3>()).toRotationMatrix()), shift_(x.tail<3>()) {
  max_displacement_ = shift_.norm() + pair.radius() * (rotation_ - Eigen::Matrix3d::Identity()).norm();
}

/// Relative to the centre.
Vec3 RelativePose::moved(const InteriorSample& sample) const {
  return sample.of_a ? Vec3(rotation_ * sample.at + shift_) : Vec3(rotation_.transpose() * (sample.at - shift_));
}

Vec3 RelativePose::in_frame_of_obstacle(const InteriorSample& sample, const Vec3& moved) const {
  const SampledPair::Obstacle& obstacle = pair_->obstacle(sample);
  return obstacle.rotation * (moved + pair_->center()) + obstacle.to_local.t;
}

Vec3 RelativePose::position(const InteriorSample& sample) const { return in_frame_of_obstacle(sample, moved(sample)); }

bool RelativePose::inside(const InteriorSample& sample) const {
  return pair_->obstacle(sample).occupied.inside(position(sample));
}

std::optional<Vec3> RelativePose::position_if_near(const InteriorSample& sample) const {
  if (sample.clearance > max_displacement_) return std::nullopt;
  const Vec3 there = moved(sample);
  if ((there - sample.at).squaredNorm() < sample.clearance * sample.clearance) return std::nullopt;
  return in_frame_of_obstacle(sample, there);
}

bool RelativePose::blocked_by(const InteriorSample& sample) const {
  const std::optional<Vec3> there = position_if_near(sample);
  return there && pair_->obstacle(sample).occupied.inside(*there);
}

bool RelativePose::blocked_by_any(std::span<const std::uint32_t> samples) const {
  std::array<Vec3, 64> points;
  std::size_t count = 0;
  std::uint32_t obstacle = 0;  // of the points
  const auto any_inside = [&] {
    const bool any = pair_->obstacle(obstacle).occupied.any_inside({points.data(), count});
    count = 0;
    return any;
  };
  for (const std::uint32_t id : samples) {
    const InteriorSample& sample = pair_->samples()[id];
    const std::optional<Vec3> there = position_if_near(sample);
    if (!there) continue;
    if (count > 0 && (count == points.size() || sample.obstacle != obstacle) && any_inside()) return true;
    obstacle = sample.obstacle;
    points[count++] = *there;
  }
  return count > 0 && any_inside();
}

}  // namespace dismantle::immobility
