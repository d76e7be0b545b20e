#include "disc/disc_cage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "disc/diameter_clearance.h"
#include "disc/facets.h"
#include "disc/solid_union.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/immobility/cell_graph.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

// Smallest edge of a cell, as a share of the disc's half thickness: with smaller cells a proof needs too many.
constexpr double kSmallestEdge = 0.25;
constexpr std::size_t kWorkOfNode = 3;  // visiting a cell of the graph takes as long as testing that many facets

/// A box of positions of the disc's centre.
struct Cell {
  Aabb box;
  std::vector<std::uint32_t> around, in_reach;  ///< facets near the box, and in reach of a disc whose centre is in it
  double cost = 0;                              ///< > 0: the box's centre is excluded, by about this length
  bool empty = false, tested = false;
  int across = -1;                 ///< the normal of the plane in which no diameter fits at the box's centre
  double below = 0, above = 0;     ///< distances along that normal up to which none fits
  Vec3 open_share = Vec3::Zero();  ///< by axis: corners with room on one side minus those on the other

  bool touches(const Cell& other) const { return box.overlaps(other.box); }
};

using Graph = CellGraph<Cell>;

class Chamber {
 public:
  Chamber(const InteriorDisc& disc, const std::vector<Solid>& solids, double slack)
      : disc_(disc),
        slack_(slack),
        facets_(solids, slack),
        solids_(solids, facets_.frame()),
        clearance_(facets_, disc.radius, disc.half, slack) {
    start_ = facets_.frame().inverse() * disc.center;
    normals_ = facets_.directions(8, 0.01);  // faces that make up a hundredth of the surface bound chambers
    box_ = facets_.box();
    box_.inflate(disc.half);
  }

  /// The cells that are linked to the start, if they are cut off from the border.
  std::optional<DiscCage> closed(const DiscParameters& params, const RunContext& context) {
    const auto divisions = static_cast<std::size_t>(params.max_divisions);
    const auto facets = static_cast<std::size_t>(params.max_facets);
    if (!facets_.box().contains(start_) || !(solids_.clearance(start_) > disc_.half)) return std::nullopt;
    Cell all;
    all.box = box_;
    all.around.resize(facets_.all().size());
    std::iota(all.around.begin(), all.around.end(), 0u);
    all.in_reach = all.around;
    classify(all);
    Graph graph(all, status(all));
    std::size_t walked = 0;
    const auto work = [&] { return clearance_.work() + kWorkOfNode * (graph.work() + walked); };
    for (std::size_t round = 0; round < divisions && work() < facets; ++round) {
      if (context.should_stop()) return std::nullopt;
      const std::uint32_t exit = graph.next_exit();
      if (exit == kNoIndex) {
        return cage(graph);
      }
      if (removes_on_path(graph, exit)) continue;
      const auto size = [&](std::uint32_t n) { return graph[n].box.size().maxCoeff(); };
      const auto key = [&](std::uint32_t n) { return std::pair(graph.status(n).cost, size(n)); };
      std::uint32_t node = exit;
      for (std::uint32_t k = exit; k != kNoIndex; k = graph.parent(k), ++walked)
        if (key(k) > key(node)) node = k;
      if (!(graph.status(node).cost > 0)) {
        // All centres on the path are free, and no cell is larger than the disc is thick: most likely a way out.
        if (size(node) < 2 * disc_.half) return std::nullopt;
        divide(graph, node);
      } else if (size(node) < kSmallestEdge * disc_.half || on_the_edge(graph[node])) {
        graph.set_cost(node, 0);  // cannot be excluded by division, so it counts as free
      } else {
        divide(graph, node);
      }
    }
    return std::nullopt;
  }

 private:
  /// Returns nullopt if the start is in no cell, which only rounding can cause.
  std::optional<DiscCage> cage(const Graph& graph) const {
    DiscCage found{disc_, facets_.frame(), {}, {}};
    bool has_start = false;
    for (std::uint32_t k = 0; k < graph.size(); ++k) {
      if (!graph.reachable(k)) continue;
      found.region.push_back(graph[k].box);
      has_start = has_start || graph.has_start(k);
    }
    for (const Vec3& n : normals_) found.normals.push_back(facets_.frame().q * n);
    return has_start ? std::optional(std::move(found)) : std::nullopt;
  }

  CellStatus status(const Cell& c) const {
    CellStatus p;
    p.cost = c.cost;
    p.border_distance = std::min((c.box.lo - box_.lo).minCoeff(), (box_.hi - c.box.hi).minCoeff());
    p.on_border = !(p.border_distance > 0);
    p.has_start = c.box.contains(start_);
    return p;
  }

  void classify(Cell& cell) {
    cell.around = clearance_.around(cell.box, disc_.half, cell.around);
    cell.in_reach = clearance_.around(cell.box, disc_.half + disc_.radius, cell.in_reach);
    const double free = solids_.clearance(cell.box.center());
    cell.cost = std::max(0.0, disc_.half - free);
    cell.tested = free < 0;
    cell.empty = free + 0.5 * cell.box.size().norm() < disc_.half - slack_ ||
                 clearance_.all_near(cell.box, cell.around) || (free < 0 && solids_.contains(cell.box));
  }

  /// Removes the first cell on the path to the exit in which no diameter fits. False: there is none.
  bool removes_on_path(Graph& graph, std::uint32_t exit) {
    for (std::uint32_t k = exit; k != kNoIndex; k = graph.parent(k)) {
      Cell& cell = graph[k];
      if (cell.tested) continue;
      cell.tested = true;
      test_planes(cell);
      if (cell.empty) {
        Cell gone;
        gone.empty = true;
        graph.divide(k, {gone, {}}, {gone, {}});
        return true;
      }
      if (cell.across >= 0) graph.set_cost(k, cell.cost);
    }
    return false;
  }

  /// Tests whether a diameter fits at the cell's centre in every plane. If not, tests the whole cell.
  void test_planes(Cell& cell) {
    const Vec3 center = cell.box.center();
    for (std::size_t n = 0; n < normals_.size() && !cell.empty; ++n) {
      const Vec3& normal = normals_[n];
      const double longest = clearance_.free_half_length(center, normal, cell.in_reach);
      if (!(longest < disc_.radius)) continue;
      const double reach = 0.5 * normal.cwiseAbs().dot(cell.box.size());
      const double below = blocked_up_to(center, -normal, reach, cell),
                   above = blocked_up_to(center, normal, reach, cell);
      const bool throughout = below == reach && above == reach;
      const Vec3 share = throughout ? open_share(cell, normal) : Vec3::Constant(-1);
      const double cost = disc_.half * (1 - longest / disc_.radius) + slack_;  // > 0: not free
      if (cost > cell.cost) {
        cell.cost = cost;
        cell.across = static_cast<int>(n);
        cell.below = below;
        cell.above = above;
        cell.open_share = share.cwiseMax(0);
      }
      cell.empty = share.isZero() && clearance_.no_diameter_fits(cell.box, normal, cell.in_reach);
    }
  }

  /// Distance from a point along `direction` up to which no diameter fits into the planes perpendicular to it; at most
  /// `reach`.
  double blocked_up_to(const Vec3& from, const Vec3& direction, double reach, const Cell& cell) {
    const auto blocked = [&](double far) {
      return clearance_.free_half_length(from + far * direction, direction, cell.in_reach) < disc_.radius;
    };
    if (blocked(reach)) return reach;
    double yes = 0, no = reach;
    while (no - yes > 0.5 * disc_.half) (blocked(0.5 * (yes + no)) ? yes : no) = 0.5 * (yes + no);
    return yes;
  }

  /// By axis: the number of corners on one side where a diameter fits in the plane across the normal, minus the number
  /// on the other side. Zero if it fits at none.
  Vec3 open_share(const Cell& cell, const Vec3& normal) {
    Vec3 share = Vec3::Zero();
    bool any = false;
    for (int i = 0; i < 8; ++i) {
      const Vec3 p = 0.999 * corner(cell.box, i) + 0.001 * cell.box.center();  // not in a face that bounds the cell
      if (clearance_.free_half_length(p, normal, cell.in_reach) < disc_.radius || solids_.clearance(p) < disc_.half)
        continue;
      any = true;
      for (int k = 0; k < 3; ++k) share[k] += i & (1 << k) ? 1 : -1;
    }
    return any ? Vec3(share.cwiseAbs().cwiseMax(1e-3)) : share;
  }

  /// True if the cell is already thin along an axis on which diameters fit on one side only.
  bool on_the_edge(const Cell& cell) const {
    int k = 0;
    return cell.across >= 0 && cell.open_share.maxCoeff(&k) >= 1 && cell.box.size()[k] < disc_.half;
  }

  void divide(Graph& graph, std::uint32_t node) {
    const auto [axis, at] = division(graph[node]);
    Cell whole = std::move(graph[node]), below, above;
    graph[node].box = below.box = above.box = whole.box;
    below.around = above.around = std::move(whole.around);
    below.in_reach = above.in_reach = std::move(whole.in_reach);
    below.box.hi[axis] = above.box.lo[axis] = at;
    classify(below);
    classify(above);
    const CellStatus first = status(below), second = status(above);
    graph.divide(node, {std::move(below), first}, {std::move(above), second});
  }

  using Division = std::pair<int, double>;  // an axis, and where on it

  Division division(const Cell& cell) const {
    if (const auto end = end_of_blocked(cell)) return *end;
    if (const auto face = beside_face(cell)) return *face;
    const Aabb& box = cell.box;
    if (cell.across >= 0 && cell.open_share.maxCoeff() >= 1) {
      const Vec3 normal = normals_[cell.across].cwiseAbs();
      Vec3 share = box.size().cwiseProduct((Vec3::Ones() - normal.cwiseAbs2()).cwiseMax(0).cwiseSqrt()) / disc_.radius;
      if (!(normal.maxCoeff() > kSameDirection))
        share += box.size().cwiseProduct(normal) / (cell.above + cell.below + disc_.half);
      return halved(box, cell.open_share + 0.1 * share);
    }
    return halved(box, cell.across >= 0 || !(cell.cost > 0) ? box.size() : changes(box));
  }

  /// The end of the range along the normal in which no diameter fits.
  std::optional<Division> end_of_blocked(const Cell& cell) const {
    int k = 0;
    if (cell.across < 0 || !(normals_[cell.across].cwiseAbs().maxCoeff(&k) > kSameDirection)) return std::nullopt;
    const bool along = normals_[cell.across][k] > 0;
    const double down = along ? cell.below : cell.above, up = along ? cell.above : cell.below;
    const double middle = cell.box.center()[k];
    const bool low = fits(cell.box, k, middle - down), high = fits(cell.box, k, middle + up);
    if (low && (!high || down > up)) return Division(k, middle - down);
    if (high) return Division(k, middle + up);
    return std::nullopt;
  }

  /// Beside the largest face in the cell that is across an axis: just within the distance that the face excludes, or
  /// where two faces at right angles exclude all of the corner between them (0.65 < 1 / sqrt 2 half thicknesses).
  std::optional<Division> beside_face(const Cell& cell) const {
    const double beyond = disc_.half - 10 * slack_, beside = 0.65 * disc_.half;
    std::optional<Division> best;
    double most = 0;
    for (const std::uint32_t f : cell.around) {
      const FacetPlane& p = facets_.plane_of(f);
      int k = 0;
      if (!(p.normal.cwiseAbs().maxCoeff(&k) > kSameDirection)) continue;
      Vec3 common = cell.box.hi.cwiseMin(facets_[f].box.hi) - cell.box.lo.cwiseMax(facets_[f].box.lo);
      common[k] = 1;
      if (!(common.minCoeff() > 0) || !(common.prod() > most)) continue;
      for (const double off : {-beside, beside, -beyond, beyond}) {
        const double at = p.offset / p.normal[k] + off;
        if (!fits(cell.box, k, at)) continue;
        best = Division(k, at);
        most = common.prod();
      }
    }
    return best;
  }

  /// True if a division there is not too close to the border of the box.
  bool fits(const Aabb& box, int k, double at) const {
    const double least = 0.8 * kSmallestEdge * disc_.half;
    return at > box.lo[k] + least && at < box.hi[k] - least;
  }

  /// By axis, the largest change of the clearance.
  Vec3 changes(const Aabb& box) const {
    const Vec3 center = box.center();
    const double here = solids_.clearance(center);
    Vec3 most = 1e-6 * box.size();
    for (int k = 0; k < 3; ++k)
      for (const double side : {-0.5, 0.5})
        most[k] = std::max(most[k], std::abs(solids_.clearance(center + side * box.size()[k] * Vec3::Unit(k)) - here));
    std::array<double, 8> at;
    for (int i = 0; i < 8; ++i) at[i] = solids_.clearance(corner(box, i));
    for (int i = 0; i < 8; ++i)
      for (int k = 0; k < 3; ++k) most[k] = std::max(most[k], std::abs(at[i] - at[i ^ (1 << k)]));
    return most;
  }

  /// In halves, across the axis of the largest weight along which the box is not too small to be divided.
  Division halved(const Aabb& box, Vec3 weight) const {
    const Vec3 size = box.size();
    for (int k = 0; k < 3; ++k)
      if (size[k] < kSmallestEdge * disc_.half) weight[k] = 0;
    int k = 0;
    (weight.maxCoeff() > 0 ? weight : size).maxCoeff(&k);
    return {k, box.center()[k]};
  }

  const InteriorDisc& disc_;
  double slack_;
  Facets facets_;
  SolidUnion solids_;
  DiameterClearance clearance_;
  Vec3 start_;
  Aabb box_;
  std::vector<Vec3> normals_;
};

}  // namespace

std::optional<DiscCage> disc_cage(const InteriorDisc& disc, const std::vector<Solid>& around, double slack,
                                  const DiscParameters& params, const RunContext& context) {
  return Chamber(disc, around, slack).closed(params, context);
}

}  // namespace dismantle::immobility
