#include "dismantle/immobility/pins.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "dismantle/geometry/mesh_measure.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kLeastSpacing = 0.02;  // assembly units; closer pins find nothing more on parts of some size
constexpr double kMostPins = 6000;      // about so many for each part
constexpr double kLever = 0.85;         // of the distance of the furthest pin from an axis: about that of the others
constexpr double kLeastLever = 1e-6;    // assembly units

/// From a point of the surface to where the solid is `depth` deep; nothing where it is not.
std::optional<Vec3> sunk(const Solid& solid, const Vec3& from, const Vec3& inward, double depth) {
  Vec3 p = from + depth * inward;
  for (int k = 0; k < 24; ++k) {
    const ClosestPoint c = solid.bvh.closest(p);
    if (c.distance >= depth) return solid.bvh.inside(p) ? std::optional(p) : std::nullopt;
    if (c.distance < 1e-9 || !solid.bvh.inside(p)) return std::nullopt;
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

/// Area of the triangles whose boxes come within `reach` of the other part's.
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

std::vector<Pinned::Plane> planes_of(const Solid& solid) {
  std::vector<Pinned::Plane> planes;
  for (std::uint32_t t = 0; t < solid.mesh.triangles.size(); ++t) {
    const auto& c = solid.bvh.corners(t);
    const Vec3 u = c[1] - c[0], v = c[2] - c[0], normal = u.cross(v);
    planes.push_back({normal, normal.norm(), u.norm() + v.norm()});
  }
  return planes;
}

}  // namespace

Pinned::Pinned(const std::vector<Solid>& a, const std::vector<Solid>& b, double depth) {
  const Aabb box_a = placed_box(a), box_b = placed_box(b);
  center_ = box_a.center();
  for (const Solid& s : a)
    for (const Vec3& v : s.mesh.vertices) radius_ = std::max(radius_, (s.frame * v - center_).norm());
  const double reach = std::max(0.15, 0.1 * radius_);
  const auto spacing = [&](const std::vector<Solid>& of, const Aabb& other) {
    return std::max(kLeastSpacing, std::sqrt(area_near(of, other, reach) / kMostPins));
  };
  const double spacing_a = spacing(a, box_b), spacing_b = spacing(b, box_a);
  const double cell = 0.5 * std::min(spacing_a, spacing_b);
  for (const auto* solids : {&a, &b})
    for (const Solid& s : *solids)
      faced_.push_back({&s, s.frame.inverse(), s.frame.q.toRotationMatrix().transpose(), Occupancy(s.bvh, s.box, cell),
                        planes_of(s)});
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k) {
      add(a[i], static_cast<std::uint32_t>(a.size() + k), true, depth, spacing_a, reach);
      add(b[k], static_cast<std::uint32_t>(i), false, depth, spacing_b, reach);
    }
  Vec3 furthest = Vec3::Zero();  // from each axis: parts that are long turn about their length with little effect
  for (const Pin& p : pins_)
    for (int d = 0; d < 3; ++d) furthest[d] = std::max(furthest[d], p.at.cross(Vec3::Unit(d)).norm());
  scale_ << (kLever * furthest).cwiseMax(kLeastLever), Vec3::Ones();
}

void Pinned::add(const Solid& of, std::uint32_t faced, bool of_a, double depth, double spacing, double reach) {
  const Solid& other = *faced_[faced].solid;
  const Pose& to_other = faced_[faced].to_local;
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
        if (x + y > 1 + 1e-9) continue;
        const Vec3 s = o + x * u + y * v;
        if (!near.contains(to_other * (of.frame * s))) continue;
        const auto p = sunk(of, s, -of.normals[t], depth);
        if (!p) continue;
        const std::array<long, 3> cell{std::lround(p->x() / (0.5 * spacing)), std::lround(p->y() / (0.5 * spacing)),
                                       std::lround(p->z() / (0.5 * spacing))};
        if (!taken.insert(cell).second) continue;
        const Vec3 assembled = of.frame * *p, there = to_other * assembled;
        const double room = other.bvh.closest(there, reach).distance;
        if (room < reach && !other.bvh.inside(there)) pins_.push_back({of_a, faced, assembled - center_, room});
      }
  }
}

bool borderless(const std::vector<Solid>& solids) {
  return std::all_of(solids.begin(), solids.end(), [](const Solid& s) { return edge_use(s.mesh).closed(); });
}

Stance::Stance(const Pinned& pinned, const Vector6& x)
    : pinned_(&pinned), turn_(rotation_from_vector(x.head<3>()).toRotationMatrix()), shift_(x.tail<3>()) {
  moved_ = shift_.norm() + pinned.radius() * (turn_ - Eigen::Matrix3d::Identity()).norm();
}

Vec3 Stance::seen(const Pin& pin) const {
  const Vec3 p = pin.of_a ? Vec3(turn_ * pin.at + shift_) : Vec3(turn_.transpose() * (pin.at - shift_));
  const Pinned::Faced& faced = pinned_->faced(pin);
  return faced.turn * (p + pinned_->center()) + faced.to_local.t;
}

bool Stance::inside(const Pin& pin) const { return pinned_->faced(pin).occupied.inside(seen(pin)); }

}  // namespace dismantle::immobility
