#include "depth_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dismantle/geometry/patch.h"

namespace dismantle {

namespace {
constexpr std::size_t kMostCells = 200'000;
}

DepthField::DepthField(const geometry::Solid& solid) : solid_(solid) {
  add(solid.box.center(), 0.5 * solid.box.size().maxCoeff(), std::numeric_limits<double>::infinity());
}

void DepthField::add(const Eigen::Vector3d& center, double half, double bound) {
  const double depth = geometry::escape_at(center, solid_).depth;
  cells_.push_back({center, half, depth, std::min(bound, depth + std::numbers::sqrt3 * half)});
}

bool DepthField::at_most(double level, const Aabb& box, double least) { return at_most(0, level, box, least); }

bool DepthField::at_most(std::uint32_t cell, double level, const Aabb& box, double least) {
  const Cell here = cells_[cell];
  if (here.bound <= level) return true;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(here.half);
  if (!box.overlaps({here.center - reach, here.center + reach})) return true;
  if (here.depth > level && box.contains(here.center)) return false;
  if (here.children == 0) {
    if (here.half < least || allowed_ < 1 || cells_.size() >= kMostCells) return false;
    --allowed_;
    cells_[cell].children = static_cast<std::uint32_t>(cells_.size());
    const double half = 0.5 * here.half;
    for (int k = 0; k < 8; ++k)
      add(here.center + half * Eigen::Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1), half, here.bound);
  }
  const std::uint32_t first = cells_[cell].children;
  // What is deep is mostly seen from the first few cells.
  for (std::uint32_t k = first; k < first + 8; ++k)
    if (cells_[k].depth > level && box.contains(cells_[k].center)) return false;
  for (std::uint32_t k = first; k < first + 8; ++k)
    if (!at_most(k, level, box, least)) return false;
  return true;
}

}  // namespace dismantle
