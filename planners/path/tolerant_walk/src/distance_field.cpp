#include "dismantle/tolerant_walk/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dismantle/geometry/mesh_measure.h"

namespace dismantle::tolerant_walk {
namespace {

constexpr double kMostBlocks = 4e6;  // per grid; bounds memory, so huge parts get larger cells

Aabb inflated(Aabb box, double by) {
  box.inflate(by);
  return box;
}

}  // namespace

DistanceField::Grid::Grid(const Aabb& box, double cell) : box_(box), cell_(cell) {
  const double blocks = (box_.size() / (kCells * cell_)).array().ceil().prod();
  if (blocks > kMostBlocks) cell_ *= std::cbrt(blocks / kMostBlocks);
  inverse_cell_ = 1 / cell_;
  for (std::size_t k = 0; k < 3; ++k) {
    blocks_[k] = static_cast<std::int64_t>(box_.size()[static_cast<Eigen::Index>(k)] / (kCells * cell_)) + 1;
    count_ *= static_cast<std::size_t>(blocks_[k]);
  }
  known_ = std::make_unique<std::atomic<Block*>[]>(count_);
}

DistanceField::Grid::~Grid() {
  for (std::size_t k = 0; k < count_; ++k) delete known_[k].load(std::memory_order_relaxed);
}

DistanceField::Grid::Block& DistanceField::Grid::make(std::atomic<Block*>& place) {
  auto made = std::make_unique<Block>();
  for (auto& value : *made) value.store(std::numeric_limits<float>::quiet_NaN(), std::memory_order_relaxed);
  Block* known = nullptr;
  if (!place.compare_exchange_strong(known, made.get(), std::memory_order_acq_rel))
    return *known;  // another thread was faster
  ++blocks_known_;
  return *made.release();
}

/// Between neighbouring grid points the distance changes by at most one cell, and the sign only where the surface is
/// nearer than one cell.
DistanceField::Grid::Known DistanceField::Grid::from_neighbours(const Block& block, std::ptrdiff_t place) const {
  const auto edge = static_cast<std::ptrdiff_t>(kBlock);
  const auto reach = static_cast<float>(1.01 * cell_);
  Known known{0, std::numeric_limits<double>::infinity()};
  std::ptrdiff_t stride = 1;
  for (int axis = 0; axis < 3; ++axis, stride *= edge) {
    const std::ptrdiff_t along = place / stride % edge;
    for (const int step : {-1, 1}) {
      if (along + step < 0 || along + step >= edge) continue;
      const float value = block[static_cast<std::size_t>(place + step * stride)].load(std::memory_order_relaxed);
      if (std::isnan(value)) continue;
      known.bound = std::min(known.bound, static_cast<double>(std::abs(value) + reach));
      if (std::abs(value) > reach) known.sign = value < 0 ? -1 : 1;
    }
  }
  return known;
}

double DistanceField::Grid::at(const Eigen::Vector3d& p, const DistanceField* field) {
  const Eigen::Vector3d u = (p - box_.lo) * inverse_cell_;
  std::array<std::int64_t, 3> b;
  std::array<std::size_t, 3> i;
  std::array<float, 3> f;
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = u[static_cast<Eigen::Index>(k)];
    const auto cell = std::min(static_cast<std::int32_t>(x), static_cast<std::int32_t>(blocks_[k]) * kCells - 1);
    b[k] = cell / kCells;
    i[k] = static_cast<std::size_t>(cell % kCells);
    f[k] = static_cast<float>(x - static_cast<double>(cell));
  }
  auto& place_of_block = known_[static_cast<std::size_t>((b[2] * blocks_[1] + b[1]) * blocks_[0] + b[0])];
  Block* block = place_of_block.load(std::memory_order_acquire);
  if (block == nullptr) {
    if (field == nullptr) return std::numeric_limits<double>::quiet_NaN();
    block = &make(place_of_block);
  }
  std::atomic<float>* const v = block->data() + (i[2] * kBlock + i[1]) * kBlock + i[0];
  const auto interpolated = [&] {
    const auto along_x = [&](const std::atomic<float>* a) {
      const float lo = a[0].load(std::memory_order_relaxed), hi = a[1].load(std::memory_order_relaxed);
      return lo + f[0] * (hi - lo);
    };
    const auto along_y = [&](const std::atomic<float>* a) {
      const float lo = along_x(a), hi = along_x(a + kBlock);
      return lo + f[1] * (hi - lo);
    };
    const float lo = along_y(v), hi = along_y(v + kBlock * kBlock);
    return static_cast<double>(lo + f[2] * (hi - lo));
  };
  if (const double value = interpolated(); field == nullptr || !std::isnan(value)) return value;
  for (std::size_t k = 0; k < 8; ++k) {
    const std::array<std::size_t, 3> d = {k & 1, k >> 1 & 1, k >> 2};
    std::atomic<float>& known = v[(d[2] * kBlock + d[1]) * kBlock + d[0]];
    if (!std::isnan(known.load(std::memory_order_relaxed))) continue;
    Eigen::Vector3d place;
    for (std::size_t axis = 0; axis < 3; ++axis)
      place[static_cast<Eigen::Index>(axis)] =
          static_cast<double>(b[axis] * kCells + static_cast<std::int64_t>(i[axis] + d[axis]));
    Known about = from_neighbours(*block, &known - block->data());
    if (!field->closed_) about.sign = 0;  // the sign of an open mesh also changes in free space
    known.store(static_cast<float>(field->measured(box_.lo + cell_ * place, about.sign, about.bound)),
                std::memory_order_relaxed);
  }
  return interpolated();
}

// The error of interpolation is at most half the diagonal of a cell.
DistanceField::DistanceField(std::shared_ptr<const Mesh> mesh, const Resolution& resolution)
    : resolution_(resolution),
      mesh_(std::move(mesh)),
      bvh_(*mesh_, geometry::Poll{}, edge_use(*mesh_).closed() ? Surface::closed : Surface::open),
      box_(mesh_->box()),
      around_(inflated(box_, resolution.band())),
      closed_(edge_use(*mesh_).closed()),
      coarse_(around_, 8 * resolution.cell),
      fine_(around_, resolution.cell),
      surely_fine_(resolution.coarse_distance() - std::numbers::sqrt3 / 2 * (coarse_.cell() + fine_.cell())) {}

double DistanceField::measured(const Eigen::Vector3d& p, int sign, double bound) const {
  double d = bvh_.closest(p, bound).distance;
  if (!(d < bound)) d = bvh_.closest(p).distance;
  const bool inside = sign != 0 ? sign < 0 : box_.contains(p) && bvh_.inside(p);
  return inside ? -d : d;
}

std::size_t DistanceField::bytes() const {
  // The bounding volume hierarchy stores its nodes and copies of the triangles.
  return coarse_.bytes() + fine_.bytes() + bvh_.nodes().size() * (sizeof(TriangleBvh::Node) + sizeof(Triangle));
}

double DistanceField::at(const Eigen::Vector3d& p) {
  const double outside = around_.squared_distance(p);
  if (outside > 0) return resolution_.band() + std::sqrt(outside);
  const double known = fine_.at(p, nullptr);
  if (std::abs(known) < surely_fine_) return known;  // false for NaN
  const double about = coarse_.at(p, this);
  if (std::abs(about) > resolution_.coarse_distance()) return about;
  return std::isnan(known) ? fine_.at(p, this) : known;
}

}  // namespace dismantle::tolerant_walk
