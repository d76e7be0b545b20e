#include "enclosed_ball/ball_free_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "dismantle/aabb.h"
#include "dismantle/geometry/patch.h"
#include "dismantle/geometry/relative_motion.h"
#include "dismantle/immobility/geometry_names.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

/// Half diagonal of a cube of edge 1.
const double half_diagonal = 0.5 * std::sqrt(3.0);
/// The finest cells, as a share of the least distance to keep. Coarser ones are tried first: they suffice where
/// openings are clearly too narrow, and each halving takes eight times as long.
constexpr double kFinestCell = 1.0 / 16;

struct Cube {
  Vec3 center;
  double half = 0;
  double bound = 0;  ///< upper bound of the depth of its points
  bool operator<(const Cube& other) const { return bound < other.bound; }
};

struct Cell {
  std::int32_t x = 0, y = 0, z = 0;
  auto operator<=>(const Cell&) const = default;
  Vec3 center(const Vec3& origin, double edge) const { return origin + edge * Vec3(x, y, z); }
};
/// One bit per cell of the box of the walls and of a margin outside it.
class VisitedCells {
 public:
  VisitedCells(const Aabb& box, const Vec3& origin, double edge) {
    for (int k = 0; k < 3; ++k) {
      first_[k] = static_cast<std::int64_t>(std::floor((box.lo[k] - origin[k]) / edge)) - kMargin;
      size_[k] = static_cast<std::int64_t>(std::ceil((box.hi[k] - origin[k]) / edge)) + kMargin + 1 - first_[k];
      if (size_[k] > kMost) return;
    }
    if (size_[0] * size_[1] * size_[2] <= kMost) bits_.resize(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]));
  }
  /// False if there would be too many cells.
  bool usable() const { return !bits_.empty(); }
  /// False when the cell was visited before or is far outside.
  bool insert(const Cell& c) {
    const std::int64_t x = c.x - first_[0], y = c.y - first_[1], z = c.z - first_[2];
    if (x < 0 || y < 0 || z < 0 || x >= size_[0] || y >= size_[1] || z >= size_[2]) return false;
    auto bit = bits_[static_cast<std::size_t>((x * size_[1] + y) * size_[2] + z)];
    const bool fresh = !bit;
    bit = true;
    return fresh;
  }

 private:
  static constexpr std::int64_t kMargin = 2;          // the flood ends in the first cell outside
  static constexpr std::int64_t kMost = 100'000'000;  // bits: 12 MB
  std::array<std::int64_t, 3> first_{}, size_{};
  std::vector<bool> bits_;
};

/// The walls, with data that speed up distance queries.
struct PlacedWalls {
  struct Placed {
    const Wall* wall;
    Placement to_local;
    Aabb box;  ///< of all points that are too near, assembled frame
  };
  std::vector<Placed> placed;
  Aabb all;  ///< of the walls themselves

  explicit PlacedWalls(const std::vector<Wall>& walls) {
    for (const Wall& w : walls) {
      Aabb box;
      for (const auto& v : w.solid->mesh.vertices) box.extend(w.pose * v);
      all.extend(box.lo);
      all.extend(box.hi);
      box.inflate(w.distance);
      placed.push_back({&w, Placement(w.pose.inverse()), box});
    }
  }

  /// Index of a wall that is too near for all points within `reach` of `p`; placed.size() if there is none.
  std::size_t wall_too_near(const Vec3& p, double reach) const {
    for (std::size_t i = 0; i < placed.size(); ++i) {
      const double limit = placed[i].wall->distance - reach;
      if (limit <= 0 || (p.array() < placed[i].box.lo.array()).any() || (p.array() > placed[i].box.hi.array()).any())
        continue;
      if (placed[i].wall->solid->bvh.closest(placed[i].to_local * p, limit).distance < limit) return i;
    }
    return placed.size();
  }

  /// Depth in the box of all walls; negative outside.
  double inside(const Vec3& p) const { return std::min((p - all.lo).minCoeff(), (all.hi - p).minCoeff()); }
};

/// True if the centre can leave along a straight line in one of 26 directions. Most parts that are not enclosed can, so
/// no flood fill is needed for them.
bool leaves_straight(const Vec3& start, const PlacedWalls& bounds, double step) {
  for (int k = 0; k < 27; ++k) {
    const Vec3 direction(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    if (direction.isZero()) continue;
    Vec3 p = start;
    while (bounds.inside(p) >= 0 && bounds.wall_too_near(p, 0) == bounds.placed.size())
      p += step * direction.normalized();
    if (bounds.inside(p) < 0) return true;
  }
  return false;
}

enum class Flood { closed, open, given_up };

Flood flood(const Vec3& start, const PlacedWalls& bounds, double edge, std::size_t most_cells,
            const RunContext& context, FreeSpace& space) {
  const double reach = half_diagonal * edge;
  using Waiting = std::pair<double, Cell>;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> open;  // the cell nearest to the outside first
  VisitedCells visited(bounds.all, start, edge);
  if (!visited.usable()) return Flood::given_up;
  visited.insert(Cell{});
  std::vector<std::size_t> stopped(bounds.placed.size(), 0);
  std::size_t reached = 0;
  open.push({bounds.inside(start), Cell{}});
  while (!open.empty()) {
    const auto [inside, cell] = open.top();
    open.pop();
    if (inside < reach) return Flood::open;
    if (++reached > most_cells || (reached % 256 == 0 && context.should_stop())) return Flood::given_up;
    for (int k = 0; k < 6; ++k) {
      Cell next = cell;
      (k < 2 ? next.x : k < 4 ? next.y : next.z) += k % 2 == 0 ? 1 : -1;
      if (!visited.insert(next)) continue;
      const Vec3 center = next.center(start, edge);
      const std::size_t wall = bounds.wall_too_near(center, reach);
      if (wall < stopped.size())
        ++stopped[wall];
      else
        open.push({bounds.inside(center), next});
    }
  }
  space = {true, edge, reached, {}};
  for (std::size_t i = 0; i < stopped.size(); ++i)
    if (stopped[i] > 0) space.bounds.push_back(i);
  std::stable_sort(space.bounds.begin(), space.bounds.end(),
                   [&](std::size_t a, std::size_t b) { return stopped[a] > stopped[b]; });
  return Flood::closed;
}

}  // namespace

Ball inscribed_ball(const Solid& solid, std::uint64_t most_cubes) {
  Ball best;
  std::priority_queue<Cube> open;
  constexpr double kGoodEnough = 0.95;  // the last 5 % of the radius take most of the time
  const auto add = [&](const Vec3& center, double half) {
    const double depth = escape_at(center, solid).depth;
    if (depth > best.radius) best = {center, depth};
    const double bound = depth + std::sqrt(3.0) * half;
    if (kGoodEnough * bound > best.radius) open.push({center, half, bound});
  };
  const Vec3 size = solid.box.size();  // the first cubes have its shortest edge, or a twentieth of the longest
  if (!(size.minCoeff() > 0)) return best;
  const double half = 0.5 * std::max(size.minCoeff(), 0.05 * size.maxCoeff());
  const Eigen::Array3i count = (size / (2 * half)).array().ceil().cast<int>().max(1);
  for (int x = 0; x < count.x(); ++x)
    for (int y = 0; y < count.y(); ++y)
      for (int z = 0; z < count.z(); ++z) add(solid.box.lo + half * (2.0 * Vec3(x, y, z) + Vec3::Ones()), half);
  for (std::uint64_t cubes = 0; !open.empty() && cubes < most_cubes; ++cubes) {
    const Cube cube = open.top();
    open.pop();
    if (kGoodEnough * cube.bound <= best.radius) break;
    for (int k = 0; k < 8; ++k)
      add(cube.center + 0.5 * cube.half * Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1), 0.5 * cube.half);
  }
  return best;
}

FreeSpace flood_free_space(const Vec3& start, const std::vector<Wall>& walls, std::size_t most_cells,
                           const RunContext& context) {
  FreeSpace space;
  double least = std::numeric_limits<double>::infinity();
  for (const Wall& w : walls) least = std::min(least, w.distance);
  if (walls.empty() || !(least > 0)) return space;
  const PlacedWalls bounds(walls);
  if (leaves_straight(start, bounds, kFinestCell * least)) return space;
  for (double share = 0.5; share >= kFinestCell; share *= 0.5)
    if (context.should_stop() || flood(start, bounds, share * least, most_cells, context, space) != Flood::open) break;
  return space;
}

FreeSpace flood_with_cells(const Vec3& start, const std::vector<Wall>& walls, double edge, std::size_t most_cells,
                           const RunContext& context) {
  FreeSpace space;
  if (walls.empty()) return space;
  const PlacedWalls bounds(walls);
  if (!(bounds.inside(start) >= 0) || bounds.wall_too_near(start, half_diagonal * edge) < walls.size()) return space;
  flood(start, bounds, edge, most_cells, context, space);
  return space;
}

}  // namespace dismantle::immobility
