/// enclosed_ball: a ball inside the first part is too large for every gap between the other parts.
///
/// Why the part cannot leave: a surface point of another part that is nearer to the ball's centre than the radius less
/// the allowed depth would be deeper in the first part than is allowed. So the centre keeps a distance from every
/// triangle of the other parts. A flood fill of cubic cells begins at the centre and enters every cell that may contain
/// such a position. It ends before the border of the box of the other parts. So all positions that the centre can reach
/// are in a bounded component of the free positions. When the parts are apart, the centre is outside the convex hull of
/// the others. From there it can move away from the hull without coming nearer to anything: its component is unbounded.
///
/// The clearance in a cell differs from that at its centre by at most half of its diagonal. Cells are the leaves of an
/// octree. Each node passes on only the triangles that matter within it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "certificates/body.h"
#include "certificates/checker.h"
#include "certificates/nearest.h"

namespace dismantle::certificates {
namespace {

using Cell = std::array<std::int64_t, 3>;

class CellTree {
 public:
  /// Leaves have the given edge. One of them is centred at `start`. Together they cover the walls.
  CellTree(const NearestTriangles& walls, const Vec3& start, double edge, double rounding)
      : walls_(walls), edge_(edge), rounding_(rounding) {
    double most = 1;
    for (int k = 0; k < 3; ++k) {
      const double below = std::ceil((start[k] - walls.box().lo[k]) / edge) + 1;
      const double above = std::ceil((walls.box().hi[k] - start[k]) / edge) + 1;
      most = std::max(most, below + above + 1);
      origin_[k] = start[k] - (below + 0.5) * edge;
      start_[k] = below;
    }
    levels = std::max(1, static_cast<int>(std::ceil(std::log2(most))));
  }
  int levels = 0;

  Cell start() const {
    return {static_cast<std::int64_t>(start_[0]), static_cast<std::int64_t>(start_[1]),
            static_cast<std::int64_t>(start_[2])};
  }
  Vec3 center(const Cell& c) const { return origin_ + edge_ * (Vec3(c[0], c[1], c[2]) + Vec3::Constant(0.5)); }

  /// True if certainly no position in the cell keeps all distances.
  bool blocked(const Cell& cell) {
    std::uint32_t at = 0;
    if (nodes_.empty()) nodes_.push_back(node(origin_, levels, walls_.all()));
    for (int level = levels;; --level) {
      if (nodes_[at].clearance + half_diagonal(level) < -rounding_) return true;
      if (nodes_[at].clearance > half_diagonal(level)) return false;
      if (level == 1) break;  // its children are cells
      const std::size_t k = child_of(cell, level);
      if (nodes_[at].child[k] == 0) {
        const double half = std::ldexp(edge_, level - 1);
        const Vec3 corner = nodes_[at].corner + half * Vec3(k & 1, k >> 1 & 1, k >> 2 & 1);
        Node next = node(corner, level - 1, nodes_[at].near);
        nodes_[at].child[k] = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back(std::move(next));
      }
      at = nodes_[at].child[k];
    }
    return blocked(center(cell), edge_, nodes_[at].near, 2);
  }

 private:
  struct Node {
    Vec3 corner;
    double clearance = 0;  ///< at its centre
    NearestTriangles::List near;
    std::array<std::uint32_t, 8> child{};  ///< 0: not made yet
  };

  double half_diagonal(int level) const { return 0.5 * std::sqrt(3.0) * std::ldexp(edge_, level); }
  static std::size_t child_of(const Cell& c, int level) {
    std::size_t k = 0;
    for (std::size_t d = 0; d < 3; ++d) k |= static_cast<std::size_t>(c[d] >> (level - 1) & 1) << d;
    return k;
  }
  Node node(const Vec3& corner, int level, const NearestTriangles::List& list) const {
    Node n;
    n.corner = corner;
    n.clearance =
        walls_.clearance(corner + Vec3::Constant(0.5 * std::ldexp(edge_, level)), list, half_diagonal(level), n.near);
    return n;
  }
  /// Divides a cell that is not proved blocked as a whole, unless its centre is free.
  bool blocked(const Vec3& at, double edge, const NearestTriangles::List& near, int divisions) const {
    const double clearance = walls_.clearance(at, near);
    if (clearance + 0.5 * std::sqrt(3.0) * edge < -rounding_) return true;
    if (clearance >= 0 || divisions == 0) return false;
    for (int k = 0; k < 8; ++k)
      if (!blocked(at + 0.25 * edge * Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1), 0.5 * edge, near,
                   divisions - 1))
        return false;
    return true;
  }

  const NearestTriangles& walls_;
  double edge_, rounding_;
  Vec3 origin_, start_;
  std::vector<Node> nodes_;
};

/// Why the flood fill does not stay within the walls; empty when it does.
std::string flood(const NearestTriangles& walls, const Vec3& start, double edge, const RunContext& context) {
  const auto outside = [&](const Vec3& p) {
    return ((p - walls.box().lo).minCoeff() < 0.5 * edge) || ((walls.box().hi - p).minCoeff() < 0.5 * edge);
  };
  if (outside(start)) return "its ball is not between the other parts";
  if (walls.box().size().maxCoeff() > 1e6 * edge) return "its cells are too small";  // for key()
  CellTree cells(walls, start, edge, rounding_of(walls.box()));
  const auto key = [&](const Cell& c) { return (c[0] << 42) | (c[1] << 21) | c[2]; };
  std::unordered_set<std::int64_t> seen{key(cells.start())};
  std::vector<Cell> pending{cells.start()};
  std::size_t reached = 0;
  while (!pending.empty()) {
    const Cell cell = pending.back();
    pending.pop_back();
    if (outside(cells.center(cell))) return "there is a way out for its ball";
    // Four times the limit of the prover.
    if (++reached > 4'000'000) return "its ball can be in too many cells";
    if (reached % 256 == 0 && context.should_stop()) return "the check was stopped";
    for (std::size_t d = 0; d < 3; ++d)
      for (const int by : {-1, 1}) {
        Cell next = cell;
        next[d] += by;
        if (seen.insert(key(next)).second && !cells.blocked(next)) pending.push_back(next);
      }
  }
  return {};
}

}  // namespace

std::string objection_to_enclosed_ball(const Certificate& certificate, const SeparationQuery& query,
                                       const RunContext& context) {
  const PartId holder = certificate.parts.front();
  const auto& center = certificate.numbers.at("center");
  const Vec3 c(center[0], center[1], center[2]);
  const double radius = certificate.numbers.at("radius").front(), edge = certificate.numbers.at("cell").front();
  double held = 0;
  if (!(radius > 0) || !(edge > 0)) return "its ball or its cells have no size";
  for (const Body& body : bodies_of(query, holder))
    if (body.closed) held = std::max(held, depth(c, body));
  if (!(held >= radius - rounding_of(query, holder)))
    return fmt::format("the part holds a ball of radius {:.6g} there, not {:.6g}", held, radius);
  NearestTriangles walls;
  for (const PlacedPart& part : query.fixed) {
    const double keep = radius - allowed_depth(query, holder, part.part);
    if (!(keep > 0)) continue;
    for (const Body& body : bodies_of(query, part.part)) walls.add(body, part.pose, keep);
  }
  if (walls.all().empty()) return "its ball is too small to touch any other part";
  return flood(walls, query.moving.front().pose * c, edge, context);
}

}  // namespace dismantle::certificates
