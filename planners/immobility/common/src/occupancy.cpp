#include "dismantle/immobility/occupancy.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kMostCells = 4e6;
constexpr std::size_t kMostTriangles = 48;  // of a cell with more, the whole solid is asked
constexpr double kCellRounding = 1e-9;      // assembly units
constexpr double kTooFlat = 1e-10;  // six times a volume, of the product of its edges: too flat to tell its sign

}  // namespace

const Occupancy::Mixed Occupancy::kIn, Occupancy::kOut;

Occupancy::Occupancy(const TriangleBvh& surface, const Aabb& box, double cell) : surface_(&surface), box_(box) {
  const Vec3 size = box.size();
  // Long parts with fine pins would need too many cells.
  cell_ = std::max(cell, std::cbrt(size.prod() / kMostCells));
  for (std::size_t k = 0; k < 3; ++k)
    count_[k] = static_cast<std::size_t>(size[static_cast<Eigen::Index>(k)] / cell_) + 1;
  cells_ = std::make_unique<std::atomic<State>[]>(count_[0] * count_[1] * count_[2]);
}

Occupancy::~Occupancy() {
  if (!cells_) return;  // moved from
  for (std::size_t i = 0; i < count_[0] * count_[1] * count_[2]; ++i)
    if (const State state = cells_[i].load(); state != &kIn && state != &kOut) delete state;
}

auto Occupancy::look(const Vec3& center) const -> State {
  const double reach = 0.5 * std::sqrt(3.0) * cell_ + kCellRounding;
  const int winding = surface_->winding_number(center);
  if (surface_->closest(center, 2 * reach).distance > reach) return winding > 0 ? &kIn : &kOut;
  auto mixed = std::make_unique<Mixed>();
  mixed->center = center;
  mixed->winding = winding;
  Aabb box;
  box.extend(center);
  box.inflate(0.5 * cell_ + kCellRounding);
  surface_->overlapping(box, [&](std::uint32_t t) { mixed->triangles.push_back(t); });
  return mixed.release();
}

/// By how much the winding number changes from the centre of a cell to a point of it: each triangle on the way counts,
/// by its side. Nothing: an edge or a corner is in the way, or it cannot be told from one.
std::optional<int> Occupancy::crossings(const Mixed& cell, const Vec3& to) const {
  if (cell.triangles.size() > kMostTriangles) return std::nullopt;
  const Vec3 way = to - cell.center;
  int sum = 0;
  for (const std::uint32_t t : cell.triangles) {
    const auto& corners = surface_->corners(t);
    const Vec3 a = corners[0] - cell.center, b = corners[1] - cell.center, c = corners[2] - cell.center;
    const Vec3 normal = (b - a).cross(c - a);
    const double from_height = -normal.dot(a), to_height = normal.dot(way) + from_height;
    // Of the edges, not of the normal: that of a sliver is mostly rounding.
    const double flat = kTooFlat * (b - a).norm() * (c - a).norm() * (a.norm() + way.norm());
    // Both on one side, and not by a hair.
    if ((from_height > flat && to_height > flat) || (from_height < -flat && to_height < -flat)) continue;
    const double u = way.dot(a.cross(b)), v = way.dot(b.cross(c)), w = way.dot(c.cross(a));
    const double hair =
        kTooFlat * way.norm() * std::max({a.norm() * b.norm(), b.norm() * c.norm(), c.norm() * a.norm()});
    // The line passes the triangle by.
    if ((u > hair || v > hair || w > hair) && (u < -hair || v < -hair || w < -hair)) continue;
    if (std::min({std::abs(u), std::abs(v), std::abs(w)}) <= hair ||
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
    State found = look(center);
    if (cells_[index].compare_exchange_strong(state, found, std::memory_order_acq_rel)) {
      state = found;
    } else if (found != &kIn && found != &kOut) {
      delete found;  // another thread was first, and found the same
    }
  }
  if (state == &kIn || state == &kOut) return state == &kIn;
  if (const auto change = crossings(*state, local)) return state->winding + *change > 0;
  return surface_->inside(local);
}

}  // namespace dismantle::immobility
