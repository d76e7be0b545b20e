#include "hook/hook_cage.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "dismantle/executor.h"
#include "dismantle/geometry/patch.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility/section.h"
#include "hook/bar_nodes.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;
using std::numbers::pi;

constexpr std::size_t kDirections = 150;         // in which a bend's lines are looked for
constexpr std::size_t kNear = 40;                // nodes on each side of a hole where bends are looked for
constexpr int kStepsAlong = 14;                  // of a bend's lines; each half of what the corner keeps
constexpr std::size_t kShortest = 8;             // ... and fewer are no line
constexpr int kFinest = 6;                       // halvings of the faces of a cube of directions
constexpr std::size_t kMostCaps = 8000;          // a third of all: with so many directions left there is no proof
constexpr std::uint64_t kMostLooks = 6'000'000;  // at distances, for one bend
constexpr double kLeast = 50 * pi / 180;         // a bend is no less than that

/// What the surface of another part keeps from the points of a line through the bar; until it keeps nothing.
std::vector<double> kept_along(const Solid& bar, const Vec3& from, const Vec3& direction, double step, double depth) {
  std::vector<double> keep;
  for (int k = 0; k < kStepsAlong; ++k) {
    const double d = escape_at(bar.frame.inverse() * (from + k * step * direction), bar).depth - depth;
    if (!(d > 0.5 * step)) break;  // so that nothing gets between two points
    keep.push_back(d);
  }
  return keep;
}

struct Line {
  Vec3 along;
  std::vector<double> keep;
  double worth = 0;  ///< sum of keep
};

Line line_along(const Solid& bar, const Vec3& corner, const Vec3& along, double step, double depth) {
  Line line{along, kept_along(bar, corner, along, step, depth), 0};
  for (const double d : line.keep) line.worth += d;
  return line;
}

/// Turned to where it keeps more, while `suits` holds of its direction.
template <class Suits>
Line improved(const Solid& bar, const Vec3& corner, Line best, double by, double step, double depth,
              const Suits& suits) {
  for (; by > 0.004; by *= 0.5)
    for (int k = 0; k < 8; ++k) {
      const Vec3 e = best.along.unitOrthogonal(), f = best.along.cross(e);
      const double a = k * pi / 4;
      const Vec3 along = (best.along + by * (std::cos(a) * e + std::sin(a) * f)).normalized();
      if (!suits(along)) continue;
      Line next = line_along(bar, corner, along, step, depth);
      if (next.worth > best.worth) best = std::move(next);
    }
  return best;
}

/// Two lines through the bar from one place, and what both keep: what is bent the most keeps the most away.
struct Corner {
  Node node;
  Vec3 at;
  Line first, second;
  double worth() const { return (first.worth + second.worth) * first.along.cross(second.along).norm(); }
  std::size_t length() const { return std::min(first.keep.size(), second.keep.size()); }
};

bool is_bend(const Vec3& a, const Vec3& b) { return std::abs(a.dot(b)) < std::cos(kLeast); }

std::optional<Corner> glance(const Solid& bar, const Node& node, double depth) {
  const double step = 0.5 * node.keep;
  std::vector<Line> lines;
  for (std::size_t k = 0; k < kDirections; ++k) {  // a spiral from pole to pole
    const double z = 1 - (2 * k + 1.0) / kDirections, r = std::sqrt(1 - z * z), a = k * pi * (3 - std::sqrt(5.0));
    lines.push_back(line_along(bar, node.at, {r * std::cos(a), r * std::sin(a), z}, step, depth));
  }
  const auto better = [](const Line& a, const Line& b) { return a.worth < b.worth; };
  const Line first = *std::max_element(lines.begin(), lines.end(), better);
  std::erase_if(lines, [&](const Line& l) { return !is_bend(first.along, l.along); });
  if (lines.empty()) return std::nullopt;
  Corner corner{node, node.at, first, *std::max_element(lines.begin(), lines.end(), better)};
  // At a glance lines are not straight along the bar; half of what is wanted will do.
  return corner.length() >= kShortest / 2 ? std::optional(corner) : std::nullopt;
}

/// Moved and turned a little to where it keeps more.
std::optional<Bend> refined(const Solid& bar, Corner corner, double depth) {
  const double step = 0.5 * corner.node.keep;
  const auto turned = [&](const Vec3& at, const Line& one, const Line& two, double by) {
    const auto any = [](const Vec3&) { return true; };
    Corner c{corner.node, at, improved(bar, at, line_along(bar, at, one.along, step, depth), by, step, depth, any), {}};
    const auto bends = [&](const Vec3& along) { return is_bend(c.first.along, along); };
    c.second = improved(bar, at, line_along(bar, at, two.along, step, depth), by, step, depth, bends);
    return c;
  };
  corner = turned(corner.at, corner.first, corner.second, 0.15);
  for (double by = 0.4 * corner.node.keep; by > 0.02 * corner.node.keep; by *= 0.5)
    for (int k = 0; k < 4; ++k) {
      const Vec3 at = corner.at + (k % 2 == 0 ? by : -by) * (k < 2 ? corner.first : corner.second).along;
      if ((at - corner.node.at).norm() > kJoined * corner.node.keep) continue;
      Corner next = turned(at, corner.first, corner.second, 0.05);
      if (next.worth() > corner.worth()) corner = std::move(next);
    }
  if (corner.length() < kShortest || !is_bend(corner.first.along, corner.second.along)) return std::nullopt;
  Bend bend{corner.at, {corner.first.along, corner.second.along}, step, {}};
  for (std::size_t k = 0; k < corner.length(); ++k)
    bend.keep.push_back(std::min(corner.first.keep[k], corner.second.keep[k]));
  return bend;
}

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

/// Can the corner never be on the disc?
bool cannot_pass(const Loop& loop, const Solid& around, const Bend& bend, const RunContext& context) {
  const Ways ways(loop, around, bend, context);
  if (ways.gave_up()) return false;
  const double apart = (bend.along[0] - bend.along[1]).norm();
  for (const Cap& a : ways.directions())
    for (const Cap& b : ways.directions())
      if (std::abs((a.center - b.center).norm() - apart) <= a.radius + b.radius) return false;
  return true;
}

/// Does the segment go through the disc?
bool crosses(const Loop& loop, const Vec3& a, const Vec3& b) {
  const double ha = loop.plane.height(a), hb = loop.plane.height(b);
  return (ha > 0) != (hb > 0) && loop.around(a + ha / (ha - hb) * (b - a));
}

/// Nodes that can be reached from `from`, which is on the disc, without crossing that, nearest first.
std::vector<std::size_t> on_side(const Loop& loop, const std::vector<Node>& nodes, const Joined& joined,
                                 std::size_t from, bool above) {
  std::vector<std::size_t> list;
  std::vector<char> seen(nodes.size(), 0);
  seen[from] = 1;
  for (const std::size_t n : joined[from])
    if ((loop.plane.height(nodes[n].at) > 0) == above) {
      seen[n] = 1;
      list.push_back(n);
    }
  for (std::size_t k = 0; k < list.size(); ++k)
    for (const std::size_t n : joined[list[k]])
      if (!seen[n] && !crosses(loop, nodes[list[k]].at, nodes[n].at)) {
        seen[n] = 1;
        list.push_back(n);
      }
  return list;
}

/// On one side of the disc that a node is on: a bend that cannot pass it.
std::optional<Bend> bend_on_side(const Solid& bar, const Solid& around, double depth, const std::vector<Node>& nodes,
                                 const Joined& joined, const Loop& loop, std::size_t node, bool above,
                                 std::size_t most_bends, const RunContext& context) {
  std::vector<Corner> corners;
  std::vector<std::size_t> near = on_side(loop, nodes, joined, node, above);
  near.resize(std::min(near.size(), kNear));
  for (const std::size_t n : near)
    if (auto corner = glance(bar, nodes[n], depth)) corners.push_back(std::move(*corner));
  std::stable_sort(corners.begin(), corners.end(),
                   [](const Corner& a, const Corner& b) { return a.worth() > b.worth(); });
  corners.resize(std::min(corners.size(), most_bends), Corner{});
  for (const Corner& corner : corners) {
    const auto bend = refined(bar, corner, depth);
    // Refining must not have taken the corner to the other side: the line would cross the disc twice.
    if (bend && !crosses(loop, corner.node.at, bend->corner) && cannot_pass(loop, around, *bend, context)) return bend;
  }
  return std::nullopt;
}

}  // namespace

std::optional<HookCage> hook_cage(const Solid& bar, const std::vector<InnerBall>& middle, const Solid& around,
                                  double depth, const HookEffort& effort, const RunContext& context) {
  const std::vector<Node> nodes = nodes_of(middle, depth);
  if (nodes.size() < 8) return std::nullopt;
  const Joined joined = join(nodes);
  const Surface surface(around);
  for (const auto& [loop, node] : holes(surface, around, nodes, effort.holes)) {
    std::array<std::optional<Bend>, 2> bends;
    std::atomic<bool> passes{false};
    parallel_for(
        bends.size(), context,
        [&, &hole = loop, at = node](std::size_t side) {
          bends[side] = bend_on_side(bar, around, depth, nodes, joined, hole, at, side == 1, effort.bends, context);
          if (!bends[side]) passes = true;
        },
        [&] { return passes.load(); });
    if (bends[0] && bends[1]) return HookCage{nodes[node].at, loop.diameter(), {*bends[0], *bends[1]}};
  }
  return std::nullopt;
}

}  // namespace dismantle::immobility
