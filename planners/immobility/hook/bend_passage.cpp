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

constexpr int kFinest = 6;                       // halvings of the faces of a cube of directions
constexpr std::size_t kMostCaps = 8000;          // a third of all: with so many directions left there is no proof
constexpr std::uint64_t kMostLooks = 6'000'000;  // at distances, for one bend

/// A cell of directions: all unit vectors within `radius` (as a distance) of `center`.
struct Cap {
  int face, level, x, y;
  Vec3 center;
  double radius;
  Cap(int f, int l, int i, int k) : face(f), level(l), x(i), y(k) {
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

/// With the corner anywhere on the disc of `loop`: directions in which a line of the bend may lead.
class Ways {
 public:
  Ways(const Loop& loop, const Solid& around, const Bend& bend, const RunContext& context)
      : context_(context), loop_(loop), around_(around), bend_(bend), to_local_(around.frame.inverse()) {
    std::vector<Places> begin;  // by level
    for (int level = 0; level <= kFinest; ++level) begin.push_back(places(bend.keep[0] / (2 << (level / 3 + 1))));
    std::array<Face, 6> faces;
    parallel_for(
        faces.size(), context,
        [&](std::size_t k) {
          faces[k].places = begin;
          cover(Cap(static_cast<int>(k), 0, 0, 0), faces[k]);
        },
        [&] { return gave_up() || context.should_stop(); });
    stopped_ = context.should_stop();
    for (const Face& face : faces) found_.insert(found_.end(), face.found.begin(), face.found.end());
  }
  /// All of them, unless it gave up.
  const std::vector<Cap>& directions() const { return found_; }
  /// By what all faces take together, so it does not matter which are looked at first.
  bool gave_up() const { return stopped_ || caps_ > kMostCaps || looks_ > kMostLooks; }

 private:
  struct Places {
    double edge;
    std::vector<Vec3> centers;
  };
  struct Face {  // of a cube of directions
    std::vector<Places> places;
    std::vector<Cap> found;
  };

  double room(const Vec3& p, double limit) const { return around_.bvh.closest(to_local_ * p, limit).distance; }

  /// Squares of the disc in some of which the corner is.
  Places places(double edge) {
    Places result{edge, {}};
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
        // A square that is not within the curve, and whose centre is further from it than its corners are, has no
        // point within.
        looks_ += 2;
        if (!loop_.around(p) && room(p, half_diagonal(edge) * 1.0001) > half_diagonal(edge)) continue;
        if (room(p, std::max(needed, 0.0)) >= needed) result.centers.push_back(p);
      }
    return result;
  }
  static double half_diagonal(double edge) { return std::numbers::sqrt2 / 2 * edge; }

  bool possible(const Cap& cap, Face& face) {
    Places& places = face.places[static_cast<std::size_t>(cap.level)];
    std::uint64_t looks = 0;
    bool free = false;
    for (std::size_t at = 0; at < places.centers.size() && !free; ++at) {
      free = true;
      for (std::size_t k = bend_.keep.size(); k-- > 1 && free;) {
        const double s = static_cast<double>(k) * bend_.step;
        const double needed = bend_.keep[k] - half_diagonal(places.edge) - s * cap.radius;
        if (!(needed > 0)) continue;
        free = room(places.centers[at] + s * cap.center, needed) >= needed;
        ++looks;
      }
      if (free) std::swap(places.centers[at], places.centers.front());  // the next direction is near this one
    }
    looks_ += looks;
    return free;
  }

  void cover(const Cap& cap, Face& face) {
    if (gave_up() || context_.should_stop() || !possible(cap, face)) return;
    if (cap.level == kFinest) {
      face.found.push_back(cap);
      ++caps_;
      return;
    }
    for (int k = 0; k < 4; ++k) cover(Cap(cap.face, cap.level + 1, 2 * cap.x + k % 2, 2 * cap.y + k / 2), face);
  }

  const RunContext& context_;
  const Loop& loop_;
  const Solid& around_;
  const Bend& bend_;
  Pose to_local_;
  std::vector<Cap> found_;
  bool stopped_ = false;
  std::atomic<std::size_t> caps_{0};
  std::atomic<std::uint64_t> looks_{0};
};

}  // namespace

bool cannot_pass(const Loop& loop, const Solid& around, const Bend& bend, const RunContext& context) {
  const Ways ways(loop, around, bend, context);
  if (ways.gave_up()) return false;
  const double apart = (bend.along[0] - bend.along[1]).norm();
  for (const Cap& a : ways.directions())
    for (const Cap& b : ways.directions())
      if (std::abs((a.center - b.center).norm() - apart) <= a.radius + b.radius) return false;
  return true;
}

}  // namespace dismantle::immobility
