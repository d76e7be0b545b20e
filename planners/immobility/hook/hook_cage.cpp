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
#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/patch.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility/section.h"
#include "hook/bend_passage.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;
using std::numbers::pi;

// A segment between points with distances r and s from the surface is within the solid if it is shorter than r + s.
// This share of it leaves a margin.
constexpr double kWithin = 0.95;
// Steps along a leg, each of half the distance that the corner keeps. A leg of less than 8 steps is too short to stop a
// bend.
constexpr std::size_t kLeastSteps = 8;
constexpr int kMostSteps = 14;

/// A point in the middle of the bar and the distance that other surfaces keep from it.
struct Node {
  Vec3 at;
  double keep;
};

/// Nodes for a depth, thinned out: the deepest first, others only at some distance.
std::vector<Node> nodes_of(const std::vector<MedialBall>& balls, double depth, std::size_t most) {
  std::vector<Node> nodes;
  for (const MedialBall& ball : balls) {
    const Node n{ball.center, ball.radius - depth};
    if (nodes.size() == most || !(n.keep > 0.1 * depth)) break;
    // Skips close neighbours, and balls in edges and corners beside much larger balls.
    if (std::any_of(nodes.begin(), nodes.end(), [&](const Node& m) {
          const double apart = (m.at - n.at).norm();
          return apart < 0.3 * m.keep || (m.keep > 1.5 * n.keep && apart < 2 * m.keep);
        }))
      continue;
    nodes.push_back(n);
  }
  return nodes;
}

using Links = std::vector<std::vector<std::size_t>>;

struct Bar {
  const Solid& solid;
  double depth;  ///< no motion penetrates it deeper
  std::vector<Node> nodes;
  Links links;  ///< by node
};

/// A hole that the bar goes through.
struct Hole {
  Loop loop;         ///< a curve on the surface around it, close around the bar in the middle of the hole
  std::size_t node;  ///< of the bar, there
};

/// Pairs of nodes between which the straight segment is within the bar.
Links links_of(const std::vector<Node>& nodes) {
  Links links(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if ((nodes[i].at - nodes[k].at).norm() < kWithin * (nodes[i].keep + nodes[k].keep)) {
        links[i].push_back(k);
        links[k].push_back(i);
      }
  return links;
}

/// The direction of the bar at a node: the principal axis of the nodes nearby.
Vec3 bar_direction(const std::vector<Node>& nodes, std::size_t node) {
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const Node& n : nodes) {
    const Vec3 d = n.at - nodes[node].at;
    if (d.norm() < 2 * nodes[node].keep) second += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(second);
  return axes.eigenvectors().col(2);
}

std::vector<Hole> holes(const Solid& around, const std::vector<Node>& nodes, std::size_t most) {
  struct Tight {
    std::size_t node;
    Vec3 along;
    Loop loop;
  };
  std::vector<Tight> tight;
  const Surface surface(around);
  const Pose to_local = around.frame.inverse();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vec3 local = to_local * nodes[i].at;
    const double reach = 4 * nodes[i].keep;
    if (!(around.bvh.closest(local, reach).distance < reach)) continue;
    const Vec3 along = bar_direction(nodes, i);
    for (Loop& loop : surface.section({along, along.dot(nodes[i].at)}))
      if (loop.around(nodes[i].at) && loop.diameter() < 2 * reach) tight.push_back({i, along, std::move(loop)});
  }
  // Curves next to each other belong to one hole.
  std::vector<Hole> found;
  std::vector<char> taken(tight.size(), 0);
  for (std::size_t first = 0; first < tight.size() && found.size() < most; ++first) {
    if (taken[first]) continue;
    std::vector<std::size_t> hole{first};
    taken[first] = 1;
    for (std::size_t k = 0; k < hole.size(); ++k)
      for (std::size_t other = 0; other < tight.size(); ++other) {
        const Node &a = nodes[tight[hole[k]].node], &b = nodes[tight[other].node];
        if (taken[other] || (a.at - b.at).norm() > 2 * (a.keep + b.keep)) continue;
        taken[other] = 1;
        hole.push_back(other);
      }
    const Vec3 along = tight[first].along;
    std::stable_sort(hole.begin(), hole.end(), [&](std::size_t a, std::size_t b) {
      return along.dot(nodes[tight[a].node].at) < along.dot(nodes[tight[b].node].at);
    });
    const Tight& middle = tight[hole[hole.size() / 2]];
    found.push_back({middle.loop, middle.node});
  }
  return found;
}

/// Distances that the surface of another part keeps from points along a line in the bar, up to the first point where
/// the distance is too small.
std::vector<double> keep_along(const Bar& bar, const Vec3& from, const Vec3& direction, double step) {
  std::vector<double> keep;
  for (int k = 0; k < kMostSteps; ++k) {
    const double d = escape_at(bar.solid.frame.inverse() * (from + k * step * direction), bar.solid).depth - bar.depth;
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

Line line_along(const Bar& bar, const Vec3& corner, const Vec3& along, double step) {
  Line line{along, keep_along(bar, corner, along, step), 0};
  for (const double d : line.keep) line.worth += d;
  return line;
}

/// Turns a line to where it keeps more distance, among directions for which `suits` holds.
template <class Suits>
Line improved(const Bar& bar, const Vec3& corner, Line best, double by, double step, const Suits& suits) {
  for (; by > 0.004; by *= 0.5)  // rad; a quarter of a degree
    for (int k = 0; k < 8; ++k) {
      const Vec3 e = best.along.unitOrthogonal(), f = best.along.cross(e);
      const double a = k * pi / 4;
      const Vec3 along = (best.along + by * (std::cos(a) * e + std::sin(a) * f)).normalized();
      if (!suits(along)) continue;
      Line next = line_along(bar, corner, along, step);
      if (next.worth > best.worth) best = std::move(next);
    }
  return best;
}

/// Two lines in the bar from one point. The worth prefers long, thick and sharp bends, which pass the fewest holes.
struct Corner {
  Node node;
  Vec3 at;
  Line first, second;
  double worth() const { return (first.worth + second.worth) * first.along.cross(second.along).norm(); }
  std::size_t length() const { return std::min(first.keep.size(), second.keep.size()); }
};

bool is_bend(const Vec3& a, const Vec3& b, double min_bend) { return std::abs(a.dot(b)) < std::cos(min_bend); }

/// The best two of 150 directions, on a Fibonacci sphere: about 16 degrees apart.
std::optional<Corner> coarse_corner(const Bar& bar, const Node& node, double min_bend) {
  const double step = 0.5 * node.keep;
  constexpr std::size_t kDirections = 150;
  std::vector<Line> lines;
  for (std::size_t k = 0; k < kDirections; ++k) {
    const double z = 1 - (2 * k + 1.0) / kDirections, r = std::sqrt(1 - z * z), a = k * pi * (3 - std::sqrt(5.0));
    lines.push_back(line_along(bar, node.at, {r * std::cos(a), r * std::sin(a), z}, step));
  }
  const auto better = [](const Line& a, const Line& b) { return a.worth < b.worth; };
  const Line first = *std::max_element(lines.begin(), lines.end(), better);
  std::erase_if(lines, [&](const Line& l) { return !is_bend(first.along, l.along, min_bend); });
  if (lines.empty()) return std::nullopt;
  Corner corner{node, node.at, first, *std::max_element(lines.begin(), lines.end(), better)};
  // These lines are only roughly along the bar, so half of the required length is enough here.
  return corner.length() >= kLeastSteps / 2 ? std::optional(corner) : std::nullopt;
}

/// Moves and turns the corner a little to where it keeps more distance.
std::optional<Bend> refined(const Bar& bar, Corner corner, double min_bend) {
  const double step = 0.5 * corner.node.keep;
  const auto turned = [&](const Vec3& at, const Line& one, const Line& two, double by) {
    const auto any = [](const Vec3&) { return true; };
    Corner c{corner.node, at, improved(bar, at, line_along(bar, at, one.along, step), by, step, any), {}};
    const auto bends = [&](const Vec3& along) { return is_bend(c.first.along, along, min_bend); };
    c.second = improved(bar, at, line_along(bar, at, two.along, step), by, step, bends);
    return c;
  };
  corner = turned(corner.at, corner.first, corner.second, 0.15);
  for (double by = 0.4 * corner.node.keep; by > 0.02 * corner.node.keep; by *= 0.5)
    for (int k = 0; k < 4; ++k) {
      const Vec3 at = corner.at + (k % 2 == 0 ? by : -by) * (k < 2 ? corner.first : corner.second).along;
      if ((at - corner.node.at).norm() > kWithin * corner.node.keep) continue;
      Corner next = turned(at, corner.first, corner.second, 0.05);
      if (next.worth() > corner.worth()) corner = std::move(next);
    }
  if (corner.length() < kLeastSteps || !is_bend(corner.first.along, corner.second.along, min_bend)) return std::nullopt;
  Bend bend{corner.at, {corner.first.along, corner.second.along}, step, {}};
  for (std::size_t k = 0; k < corner.length(); ++k)
    bend.keep.push_back(std::min(corner.first.keep[k], corner.second.keep[k]));
  return bend;
}

/// True if the segment crosses the disc.
bool crosses(const Loop& loop, const Vec3& a, const Vec3& b) {
  const double ha = loop.plane.height(a), hb = loop.plane.height(b);
  return (ha > 0) != (hb > 0) && loop.around(a + ha / (ha - hb) * (b - a));
}

/// A node, and the one before it on the way from the disc (an index in the same list, or kNoIndex: the node on the
/// disc).
struct Reached {
  std::size_t node;
  std::uint32_t before;
};

/// Nodes on one side of the disc that can be reached from its node without crossing it; the fewest links first.
std::vector<Reached> on_side(const Bar& bar, const Hole& hole, bool above) {
  std::vector<Reached> list;
  std::vector<char> seen(bar.nodes.size(), 0);
  seen[hole.node] = 1;
  for (const std::size_t n : bar.links[hole.node])
    if ((hole.loop.plane.height(bar.nodes[n].at) > 0) == above) {
      seen[n] = 1;
      list.push_back({n, kNoIndex});
    }
  for (std::uint32_t k = 0; k < list.size(); ++k)
    for (const std::size_t n : bar.links[list[k].node])
      if (!seen[n] && !crosses(hole.loop, bar.nodes[list[k].node].at, bar.nodes[n].at)) {
        seen[n] = 1;
        list.push_back({n, k});
      }
  return list;
}

/// A bend, and the line to it from the node on the disc, without that node.
struct BendWithPath {
  Bend bend;
  std::vector<Vec3> path;
};

/// Corners of the bar on one side of the disc that may be bends, with their place in `near`; the worthiest first.
std::vector<std::pair<Corner, std::uint32_t>> corners_of(const Bar& bar, const std::vector<Reached>& near,
                                                         const HookParameters& params) {
  std::vector<std::pair<Corner, std::uint32_t>> corners;
  constexpr std::uint32_t kMostNodes = 40;  // a bend further away lets the bar slide to it
  for (std::uint32_t k = 0; k < near.size() && k < kMostNodes; ++k)
    if (auto corner = coarse_corner(bar, bar.nodes[near[k].node], params.min_bend))
      corners.emplace_back(std::move(*corner), k);
  std::stable_sort(corners.begin(), corners.end(),
                   [](const auto& a, const auto& b) { return a.first.worth() > b.first.worth(); });
  if (corners.size() > static_cast<std::size_t>(params.max_bends))
    corners.erase(corners.begin() + params.max_bends, corners.end());
  return corners;
}

/// A bend of the bar on one side of the disc that cannot pass the disc.
std::optional<BendWithPath> bend_on_side(const Bar& bar, const Solid& around, const Hole& hole, bool above,
                                         const HookParameters& params, const RunContext& context) {
  const std::vector<Reached> near = on_side(bar, hole, above);
  for (const auto& [corner, place] : corners_of(bar, near, params)) {
    const auto bend = refined(bar, corner, params.min_bend);
    // If the refined corner is on the other side, the line crosses the disc twice, and the proof does not apply.
    if (bend && !crosses(hole.loop, corner.node.at, bend->corner) &&
        cannot_pass(hole.loop, around, *bend, static_cast<std::uint64_t>(params.max_distances), context)) {
      BendWithPath found{*bend, {bend->corner}};
      for (std::uint32_t k = place; k != kNoIndex; k = near[k].before) found.path.push_back(bar.nodes[near[k].node].at);
      return found;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<HookCage> hook_cage(const Solid& solid, const std::vector<MedialBall>& balls, const Solid& around,
                                  double depth, const HookParameters& params, const RunContext& context) {
  Bar bar{solid, depth, nodes_of(balls, depth, static_cast<std::size_t>(params.max_nodes)), {}};
  if (bar.nodes.size() < kLeastSteps) return std::nullopt;
  bar.links = links_of(bar.nodes);
  for (const Hole& hole : holes(around, bar.nodes, static_cast<std::size_t>(params.max_holes))) {
    std::array<std::optional<BendWithPath>, 2> bends;
    std::atomic<bool> passes{false};
    parallel_for(
        bends.size(), context,
        [&](std::size_t side) {
          bends[side] = bend_on_side(bar, around, hole, side == 1, params, context);
          if (!bends[side]) passes = true;
        },
        [&] { return passes.load(); });
    if (!bends[0] || !bends[1]) continue;
    const Vec3 middle = bar.nodes[hole.node].at;
    std::vector<Vec3> path = bends[0]->path;
    path.push_back(middle);
    path.insert(path.end(), bends[1]->path.rbegin(), bends[1]->path.rend());
    return HookCage{hole.loop.plane.normal, path, middle, hole.loop.diameter(), {bends[0]->bend, bends[1]->bend}};
  }
  return std::nullopt;
}

}  // namespace dismantle::immobility
