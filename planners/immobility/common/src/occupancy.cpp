#include "dismantle/immobility/occupancy.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "dismantle/geometry/numerics.h"
#include "dismantle/immobility/geometry_names.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

}  // namespace

const Occupancy::Mixed Occupancy::in_, Occupancy::out_;

Occupancy::Occupancy(const TriangleBvh& surface, const Aabb& box, double cell) : surface_(&surface), box_(box) {
  const Vec3 size = box.size();
  // At most about 4 million cells of 8 bytes: large parts with fine samples would need more memory than they are worth.
  cell_ = std::max(cell, std::cbrt(size.prod() / 4e6));
  rounding_ = kRounding * size.norm();
  for (std::size_t k = 0; k < 3; ++k)
    count_[k] = static_cast<std::size_t>(size[static_cast<Eigen::Index>(k)] / cell_) + 1;
  cells_ = std::make_unique<std::atomic<State>[]>(count_[0] * count_[1] * count_[2]);
}

Occupancy::~Occupancy() {
  if (!cells_) return;  // moved from
  for (std::size_t i = 0; i < count_[0] * count_[1] * count_[2]; ++i)
    if (const State state = cells_[i].load(); state != &in_ && state != &out_) delete state;
}

auto Occupancy::classify(const Vec3& center) const -> State {
  const double reach = 0.5 * std::sqrt(3.0) * cell_ + rounding_;
  const int winding = surface_->winding_number(center);
  if (surface_->closest(center, 2 * reach).distance > reach) return winding > 0 ? &in_ : &out_;
  auto mixed = std::make_unique<Mixed>();
  mixed->center = center;
  mixed->winding = winding;
  Aabb box;
  box.extend(center);
  box.inflate(0.5 * cell_ + rounding_);
  surface_->overlapping(box, [&](std::uint32_t t) { mixed->triangles.push_back(t); });
  return mixed.release();
}

/// The change of the winding number from the centre of a cell to a point of it: each triangle that the segment crosses
/// counts with the sign of its side. Nothing: the segment may pass through an edge or a corner.
std::optional<int> Occupancy::crossings(const Mixed& cell, const Vec3& to) const {
  // Each triangle costs a few dozen operations; with more, the hierarchy of the whole solid is faster.
  if (cell.triangles.size() > 48) return std::nullopt;
  // Six times the volume of a tetrahedron, as a share of the product of its edges. Below this, rounding decides the
  // sign.
  constexpr double kTooFlat = 0.1 * kRounding;
  const Vec3 displacement = to - cell.center;
  int sum = 0;
  for (const std::uint32_t t : cell.triangles) {
    const auto& corners = surface_->corners(t);
    const Vec3 a = corners[0] - cell.center, b = corners[1] - cell.center, c = corners[2] - cell.center;
    const Vec3 normal = (b - a).cross(c - a);
    const double from_height = -normal.dot(a), to_height = normal.dot(displacement) + from_height;
    // Relative to the edges, since the normal of a sliver is mostly rounding.
    const double flat = kTooFlat * (b - a).norm() * (c - a).norm() * (a.norm() + displacement.norm());
    // Both ends are certainly on one side.
    if ((from_height > flat && to_height > flat) || (from_height < -flat && to_height < -flat)) continue;
    const double u = displacement.dot(a.cross(b)), v = displacement.dot(b.cross(c)), w = displacement.dot(c.cross(a));
    const double slack =
        kTooFlat * displacement.norm() * std::max({a.norm() * b.norm(), b.norm() * c.norm(), c.norm() * a.norm()});
    // The line certainly misses the triangle.
    if ((u > slack || v > slack || w > slack) && (u < -slack || v < -slack || w < -slack)) continue;
    if (std::min({std::abs(u), std::abs(v), std::abs(w)}) <= slack ||
        std::min(std::abs(from_height), std::abs(to_height)) <= flat)
      return std::nullopt;
    sum += to_height > 0 ? -1 : 1;  // out through the front: one less
  }
  return sum;
}

bool Occupancy::inside(const Vec3& local) const {
  if (!box_.contains(local)) return false;
  std::size_t index = 0;
  Vec3 center;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto n = static_cast<Eigen::Index>(k);
    const std::size_t i = std::min(static_cast<std::size_t>((local[n] - box_.lo[n]) / cell_), count_[k] - 1);
    index = index * count_[k] + i;
    center[n] = box_.lo[n] + (static_cast<double>(i) + 0.5) * cell_;
  }
  State state = cells_[index].load(std::memory_order_acquire);
  if (state == nullptr) {
    State found = classify(center);
    if (cells_[index].compare_exchange_strong(state, found, std::memory_order_acq_rel)) {
      state = found;
    } else if (found != &in_ && found != &out_) {
      delete found;  // another thread stored the same answer first
    }
  }
  if (state == &in_ || state == &out_) return state == &in_;
  if (const auto change = crossings(*state, local)) return state->winding + *change > 0;
  return surface_->inside(local);
}

}  // namespace dismantle::immobility
