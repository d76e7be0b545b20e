#include "hook/bend_passage.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "dismantle/executor.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

// Halvings of the faces of a cube of directions. Gives cells of about 1.4 degrees, much less than the bends that are
// tried.
constexpr int kFinest = 6;

/// A cell of directions: all unit vectors within `radius` (as a distance) of `center`.
struct DirectionCell {
  int face, level, x, y;
  Vec3 center;
  double radius;
  DirectionCell(int f, int l, int i, int k) : face(f), level(l), x(i), y(k) {
    const double edge = 2.0 / (1 << l);
    const auto at = [&](double u, double v) {
      Vec3 p;
      p[f / 2] = f % 2 == 0 ? 1 : -1;
      p[(f / 2 + 1) % 3] = -1 + edge * u;
      p[(f / 2 + 2) % 3] = -1 + edge * v;
      return Vec3(p.normalized());
    };
    center = at(i + 0.5, k + 0.5);
    radius = 0;
    for (int c = 0; c < 4; ++c) radius = std::max(radius, (at(i + c % 2, k + c / 2) - center).norm());
  }
};

/// The directions in which a leg of the bend can point when the corner is anywhere on the disc of `loop`.
class LegDirections {
 public:
  LegDirections(const Loop& loop, const Solid& around, const Bend& bend, std::uint64_t max_distances,
                const RunContext& context)
      : context_(context),
        loop_(loop),
        around_(around),
        bend_(bend),
        to_local_(around.frame.inverse()),
        max_distances_(max_distances) {
    std::vector<Positions> begin;  // by level of the direction cells, since both are refined together
    for (int level = 0; level <= kFinest; ++level) begin.push_back(positions(bend.keep[0] / (2 << (level / 3 + 1))));
    std::array<Face, 6> faces;
    parallel_for(
        faces.size(), context,
        [&](std::size_t k) {
          faces[k].positions = begin;
          cover(DirectionCell(static_cast<int>(k), 0, 0, 0), faces[k]);
        },
        [&] { return gave_up() || context.should_stop(); });
    stopped_ = context.should_stop();
    for (const Face& face : faces) found_.insert(found_.end(), face.found.begin(), face.found.end());
  }
  /// A cover of all of them, unless the search gave up.
  const std::vector<DirectionCell>& directions() const { return found_; }
  /// The limits are for all faces together, so the result does not depend on the order of threads. If a third of all
  /// directions is left, two of them differ by as much as the legs do.
  bool gave_up() const {
    return stopped_ || 3 * cells_ > std::size_t{6} << (2 * kFinest) || distances_ > max_distances_;
  }

 private:
  struct Positions {
    double edge;
    std::vector<Vec3> centers;
  };
  struct Face {  // of a cube of directions
    std::vector<Positions> positions;
    std::vector<DirectionCell> found;
  };

  double distance(const Vec3& p, double limit) const { return around_.bvh.closest(to_local_ * p, limit).distance; }

  /// Squares that cover the positions of the corner on the disc.
  Positions positions(double edge) {
    Positions result{edge, {}};
    const Vec3 e = loop_.plane.normal.unitOrthogonal(), f = loop_.plane.normal.cross(e);
    double lo[2] = {1e300, 1e300}, hi[2] = {-1e300, -1e300};
    for (const Vec3& p : loop_.points)
      for (int k = 0; k < 2; ++k) {
        const double x = (k == 0 ? e : f).dot(p);
        lo[k] = std::min(lo[k], x);
        hi[k] = std::max(hi[k], x);
      }
    for (double x = lo[0] + 0.5 * edge; x < hi[0] + 0.5 * edge; x += edge)
      for (double y = lo[1] + 0.5 * edge; y < hi[1] + 0.5 * edge; y += edge) {
        const Vec3 p = x * e + y * f + loop_.plane.offset * loop_.plane.normal;
        const double needed = bend_.keep[0] - half_diagonal(edge);
        // A square has no point within the curve if its centre is outside and further from the curve than its corners.
        distances_ += 2;
        if (!loop_.around(p) && distance(p, half_diagonal(edge) * 1.0001) > half_diagonal(edge)) continue;
        if (distance(p, std::max(needed, 0.0)) >= needed) result.centers.push_back(p);
      }
    return result;
  }
  static double half_diagonal(double edge) { return std::numbers::sqrt2 / 2 * edge; }

  bool possible(const DirectionCell& cell, Face& face) {
    Positions& positions = face.positions[static_cast<std::size_t>(cell.level)];
    std::uint64_t distances = 0;
    bool free = false;
    for (std::size_t at = 0; at < positions.centers.size() && !free; ++at) {
      free = true;
      for (std::size_t k = bend_.keep.size(); k-- > 1 && free;) {
        const double s = static_cast<double>(k) * bend_.step;
        const double needed = bend_.keep[k] - half_diagonal(positions.edge) - s * cell.radius;
        if (!(needed > 0)) continue;
        free = distance(positions.centers[at] + s * cell.center, needed) >= needed;
        ++distances;
      }
      // The next direction is near this one, so this position is most likely free for it, too.
      if (free) std::swap(positions.centers[at], positions.centers.front());
    }
    distances_ += distances;
    return free;
  }

  void cover(const DirectionCell& cell, Face& face) {
    if (gave_up() || context_.should_stop() || !possible(cell, face)) return;
    if (cell.level == kFinest) {
      face.found.push_back(cell);
      ++cells_;
      return;
    }
    for (int k = 0; k < 4; ++k)
      cover(DirectionCell(cell.face, cell.level + 1, 2 * cell.x + k % 2, 2 * cell.y + k / 2), face);
  }

  const RunContext& context_;
  const Loop& loop_;
  const Solid& around_;
  const Bend& bend_;
  Pose to_local_;
  std::vector<DirectionCell> found_;
  std::uint64_t max_distances_;
  bool stopped_ = false;
  std::atomic<std::size_t> cells_{0};
  std::atomic<std::uint64_t> distances_{0};
};

}  // namespace

bool cannot_pass(const Loop& loop, const Solid& around, const Bend& bend, std::uint64_t max_distances,
                 const RunContext& context) {
  const LegDirections legs(loop, around, bend, max_distances, context);

  if (legs.gave_up()) return false;
  const double apart = (bend.along[0] - bend.along[1]).norm();
  for (const DirectionCell& a : legs.directions())
    for (const DirectionCell& b : legs.directions())
      if (std::abs((a.center - b.center).norm() - apart) <= a.radius + b.radius) return false;
  return true;
}

}  // namespace dismantle::immobility
