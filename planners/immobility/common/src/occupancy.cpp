#include "dismantle/immobility/occupancy.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "dismantle/geometry/numerics.h"
#include "dismantle/immobility/geometry_names.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

/// Each triangle costs a few operations; with more, the hierarchy of the whole solid is faster.
constexpr std::size_t kMostFacets = 48;

/// Six times the volume of a tetrahedron, as a share of the product of its edges. Below this, rounding decides the
/// sign.
constexpr double kTooFlat = 0.1 * kRounding;

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
  std::vector<std::uint32_t> triangles;
  surface_->overlapping(box, [&](std::uint32_t t) { triangles.push_back(t); });
  mixed->is_dense = triangles.size() > kMostFacets;
  if (!mixed->is_dense)
    for (const std::uint32_t t : triangles) mixed->facets.push_back(facet_of(t, center));
  return mixed.release();
}

auto Occupancy::facet_of(std::uint32_t triangle, const Vec3& center) const -> Facet {
  const auto& corners = surface_->corners(triangle);
  const Vec3 a = corners[0] - center, b = corners[1] - center, c = corners[2] - center;
  Facet facet;
  facet.normal = (b - a).cross(c - a);
  facet.height = -facet.normal.dot(a);
  facet.flat = kTooFlat * (b - a).norm() * (c - a).norm();  // of the edges: the normal of a sliver is mostly rounding
  facet.reach = a.norm();
  facet.slack = kTooFlat * std::max({a.norm() * b.norm(), b.norm() * c.norm(), c.norm() * a.norm()});
  facet.sides = {a.cross(b), b.cross(c), c.cross(a)};
  return facet;
}

/// The change of the winding number from the centre of a cell to a point of it: each triangle that the segment crosses
/// counts with the sign of its side. Nothing: the segment may pass through an edge or a corner.
std::optional<int> Occupancy::crossings(const Mixed& cell, const Vec3& to) {
  if (cell.is_dense) return std::nullopt;
  const Vec3 displacement = to - cell.center;
  const double length = displacement.norm();
  int sum = 0;
  for (const Facet& facet : cell.facets) {
    const double from_height = facet.height, to_height = facet.normal.dot(displacement) + from_height;
    const double flat = facet.flat * (facet.reach + length);
    // Both ends are certainly on one side.
    if ((from_height > flat && to_height > flat) || (from_height < -flat && to_height < -flat)) continue;
    const double u = displacement.dot(facet.sides[0]), v = displacement.dot(facet.sides[1]),
                 w = displacement.dot(facet.sides[2]);
    const double slack = facet.slack * length;
    // The line certainly misses the triangle.
    if ((u > slack || v > slack || w > slack) && (u < -slack || v < -slack || w < -slack)) continue;
    if (std::min({std::abs(u), std::abs(v), std::abs(w)}) <= slack ||
        std::min(std::abs(from_height), std::abs(to_height)) <= flat)
      return std::nullopt;
    sum += to_height > 0 ? -1 : 1;  // out through the front: one less
  }
  return sum;
}

auto Occupancy::place_of(const Vec3& local) const -> Place {
  Place place;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto n = static_cast<Eigen::Index>(k);
    const std::size_t i = std::min(static_cast<std::size_t>((local[n] - box_.lo[n]) / cell_), count_[k] - 1);
    place.index = place.index * count_[k] + i;
    place.center[n] = box_.lo[n] + (static_cast<double>(i) + 0.5) * cell_;
  }
  return place;
}

auto Occupancy::state_at(const Place& place) const -> State {
  State state = cells_[place.index].load(std::memory_order_acquire);
  if (state != nullptr) return state;
  State found = classify(place.center);
  if (cells_[place.index].compare_exchange_strong(state, found, std::memory_order_acq_rel)) return found;
  if (found != &in_ && found != &out_) delete found;  // another thread stored the same answer first
  return state;
}

bool Occupancy::inside(const Vec3& local, State state) const {
  if (state == &in_ || state == &out_) return state == &in_;
  if (const auto change = crossings(*state, local)) return state->winding + *change > 0;
  return surface_->inside(local);
}

bool Occupancy::inside(const Vec3& local) const {
  return box_.contains(local) && inside(local, state_at(place_of(local)));
}

bool Occupancy::any_inside(std::span<const Vec3> local) const {
  constexpr std::size_t kMost = 32;
  std::array<Vec3, kMost> points;
  std::array<Place, kMost> places;
  std::array<State, kMost> states;
  for (std::size_t next = 0; next < local.size();) {
    std::size_t count = 0;
    for (; next < local.size() && count < kMost; ++next) {
      if (!box_.contains(local[next])) continue;
      points[count] = local[next];
      places[count] = place_of(local[next]);
      __builtin_prefetch(&cells_[places[count].index]);
      ++count;
    }
    for (std::size_t i = 0; i < count; ++i) __builtin_prefetch(states[i] = state_at(places[i]));
    for (std::size_t i = 0; i < count; ++i)
      if (states[i] != &in_ && states[i] != &out_) __builtin_prefetch(states[i]->facets.data());
    for (std::size_t i = 0; i < count; ++i)
      if (inside(points[i], states[i])) return true;
  }
  return false;
}

}  // namespace dismantle::immobility
