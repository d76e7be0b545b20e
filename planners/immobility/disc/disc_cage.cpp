#include "disc/disc_cage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "disc/disc_room.h"
#include "disc/facets.h"
#include "disc/solid_union.h"
#include "dismantle/immobility/cell_graph.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kRounding = 1e-9;      // assembly units, for rounding
constexpr double kParallel = 0.99999;   // cosine of the angle between directions that are the same
constexpr std::size_t kDirections = 8;  // of planes
constexpr double kFace = 0.01;          // of the surface: faces in a direction, for it to count
// Of the half thickness:
constexpr double kOpen = 2;          // a way through cells no larger is open
constexpr double kLeastEdge = 0.25;  // cells that are smaller are not divided
constexpr double kLeastCut = 0.2;    // no closer to the border of a cell
constexpr double kBeside = 0.65;     // from a face: what is so near to two, at an edge, is nearer than 1 to the edge
constexpr double kInset = 1e-3;      // of half its size: corners of a cell are looked at so far inside

struct Cell {
  Aabb box;
  std::vector<std::uint32_t> around, in_reach;  // facets near the box, and in reach of a disc in it
  double narrow = 0;                            // the centre is so much too near
  bool empty = false, asked = false;
  int across = -1;                 // the normal of the plane in which the centre is shut
  double below = 0, above = 0;     // so far along it that is so
  Vec3 open_share = Vec3::Zero();  // by axis: how much more of the corners on one side are open

  bool touches(const Cell& other) const { return box.overlaps(other.box); }
};

using Graph = CellGraph<Cell>;

class Chamber {
 public:
  Chamber(const InnerDisc& disc, const std::vector<Solid>& solids)
      : disc_(disc), facets_(solids), solids_(solids, facets_.frame()), room_(facets_, disc.radius, disc.half) {
    start_ = facets_.frame().inverse() * disc.center;
    normals_ = facets_.directions(kDirections, kFace);
    box_ = facets_.box();
    box_.inflate(disc.half);
  }

  /// The number of cells, if they cut the start off from the border.
  std::optional<std::size_t> closed(const DiscEffort& effort, const RunContext& context) {
    if (!facets_.box().contains(start_) || !(solids_.clearance(start_) > disc_.half)) return std::nullopt;
    Cell all;
    all.box = box_;
    all.around.resize(facets_.all().size());
    std::iota(all.around.begin(), all.around.end(), 0u);
    all.in_reach = all.around;
    look(all);
    Graph graph(all, place(all));
    for (std::size_t round = 0; round < effort.divisions && room_.work() < effort.facets; ++round) {
      if (context.should_stop()) return std::nullopt;
      const std::uint32_t exit = graph.next_exit();
      if (exit == Graph::kNone) {
        for (std::uint32_t k = 0; k < graph.size(); ++k)
          if (graph.connected(k) && graph.holds_start(k)) return graph.size();
        return std::nullopt;  // rounding, if anything
      }
      if (shuts_on(graph, exit)) continue;
      const auto size = [&](std::uint32_t n) { return graph[n].box.size().maxCoeff(); };
      const auto key = [&](std::uint32_t n) { return std::pair(graph.place(n).narrow, size(n)); };
      std::uint32_t node = exit;
      for (std::uint32_t k = exit; k != Graph::kNone; k = graph.from(k))
        if (key(k) > key(node)) node = k;
      if (!(graph.place(node).narrow > 0)) {
        if (size(node) < kOpen * disc_.half) return std::nullopt;
        divide(graph, node);
      } else if (size(node) < kLeastEdge * disc_.half || on_the_edge(graph[node])) {
        graph.set_narrow(node, 0);  // not told from open: goes on as if it were
      } else {
        divide(graph, node);
      }
    }
    return std::nullopt;
  }

 private:
  CellPlace place(const Cell& c) const {
    CellPlace p;
    p.narrow = c.narrow;
    p.from_border = std::min((c.box.lo - box_.lo).minCoeff(), (box_.hi - c.box.hi).minCoeff());
    p.border = !(p.from_border > 0);
    p.start = c.box.contains(start_);
    return p;
  }

  void look(Cell& cell) {
    cell.around = room_.around(cell.box, disc_.half, cell.around);
    cell.in_reach = room_.around(cell.box, disc_.half + disc_.radius, cell.in_reach);
    const double free = solids_.clearance(cell.box.center());
    cell.narrow = std::max(0.0, disc_.half - free);
    cell.asked = free < 0;
    cell.empty = free + 0.5 * cell.box.size().norm() < disc_.half - kRounding || room_.near(cell.box, cell.around) ||
                 (free < 0 && solids_.contains(cell.box));
  }

  /// Shuts those on the way to the exit where the disc has no room. False: there are none.
  bool shuts_on(Graph& graph, std::uint32_t exit) {
    for (std::uint32_t k = exit; k != Graph::kNone; k = graph.from(k)) {
      Cell& cell = graph[k];
      if (cell.asked) continue;
      cell.asked = true;
      look_along(cell);
      if (cell.empty) {
        Cell gone;
        gone.empty = true;
        graph.divide(k, {gone, {}}, {gone, {}});
        return true;
      }
      if (cell.across >= 0) graph.set_narrow(k, cell.narrow);
    }
    return false;
  }

  /// Has the disc room at the cell's centre, and if not, anywhere in the cell?
  void look_along(Cell& cell) {
    const Vec3 center = cell.box.center();
    for (std::size_t n = 0; n < normals_.size() && !cell.empty; ++n) {
      const Vec3& normal = normals_[n];
      const double longest = room_.longest(center, normal, cell.in_reach);
      if (!(longest < disc_.radius)) continue;
      const double reach = 0.5 * normal.cwiseAbs().dot(cell.box.size());
      const double below = shut_up_to(center, -normal, reach, cell), above = shut_up_to(center, normal, reach, cell);
      const bool throughout = below == reach && above == reach;
      const Vec3 share = throughout ? open_share(cell, normal) : Vec3::Constant(-1);
      const double narrow = disc_.half * (1 - longest / disc_.radius) + kRounding;  // > 0: not open
      if (narrow > cell.narrow) {
        cell.narrow = narrow;
        cell.across = static_cast<int>(n);
        cell.below = below;
        cell.above = above;
        cell.open_share = share.cwiseMax(0);
      }
      cell.empty = share.isZero() && room_.shut(cell.box, normal, cell.in_reach);
    }
  }

  /// How far from a point, that way, the planes across it are shut; at most `reach`.
  double shut_up_to(const Vec3& from, const Vec3& way, double reach, const Cell& cell) {
    const auto shut = [&](double far) { return room_.longest(from + far * way, way, cell.in_reach) < disc_.radius; };
    if (shut(reach)) return reach;
    double yes = 0, no = reach;
    while (no - yes > 0.5 * disc_.half) (shut(0.5 * (yes + no)) ? yes : no) = 0.5 * (yes + no);
    return yes;
  }

  /// By axis, how many more of the corners on one side have room in the plane across the normal. Zero: none has.
  Vec3 open_share(const Cell& cell, const Vec3& normal) {
    Vec3 share = Vec3::Zero();
    bool any = false;
    for (int i = 0; i < 8; ++i) {
      const Vec3 p = (1 - kInset) * corner(cell.box, i) + kInset * cell.box.center();
      if (room_.longest(p, normal, cell.in_reach) < disc_.radius || solids_.clearance(p) < disc_.half) continue;
      any = true;
      for (int k = 0; k < 3; ++k) share[k] += i & (1 << k) ? 1 : -1;
    }
    return any ? Vec3(share.cwiseAbs().cwiseMax(1e-3)) : share;
  }

  /// Thin already where it has places on one side and none on the other.
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
    look(below);
    look(above);
    const CellPlace first = place(below), second = place(above);
    graph.divide(node, {std::move(below), first}, {std::move(above), second});
  }

  using Division = std::pair<int, double>;  // an axis, and where on it

  Division division(const Cell& cell) const {
    if (const auto end = end_of_shut(cell)) return *end;
    if (const auto face = beside_face(cell)) return *face;
    const Aabb& box = cell.box;
    if (cell.across >= 0 && cell.open_share.maxCoeff() >= 1) {
      const Vec3 normal = normals_[cell.across].cwiseAbs();
      Vec3 share = box.size().cwiseProduct((Vec3::Ones() - normal.cwiseAbs2()).cwiseMax(0).cwiseSqrt()) / disc_.radius;
      if (!(normal.maxCoeff() > kParallel))
        share += box.size().cwiseProduct(normal) / (cell.above + cell.below + disc_.half);
      return halved(box, cell.open_share + 0.1 * share);
    }
    return halved(box, cell.across >= 0 || !(cell.narrow > 0) ? box.size() : changes(box));
  }

  /// Where along the normal the plane is no longer shut.
  std::optional<Division> end_of_shut(const Cell& cell) const {
    int k = 0;
    if (cell.across < 0 || !(normals_[cell.across].cwiseAbs().maxCoeff(&k) > kParallel)) return std::nullopt;
    const bool along = normals_[cell.across][k] > 0;
    const double down = along ? cell.below : cell.above, up = along ? cell.above : cell.below;
    const double middle = cell.box.center()[k];
    const bool low = fits(cell.box, k, middle - down), high = fits(cell.box, k, middle + up);
    if (low && (!high || down > up)) return Division(k, middle - down);
    if (high) return Division(k, middle + up);
    return std::nullopt;
  }

  /// Where the largest face in the cell that is across an axis begins to be near.
  std::optional<Division> beside_face(const Cell& cell) const {
    const double beyond = disc_.half - 1e-5, beside = kBeside * disc_.half;
    std::optional<Division> best;
    double most = 0;
    for (const std::uint32_t f : cell.around) {
      const FacetPlane& p = facets_.plane_of(f);
      int k = 0;
      if (!(p.normal.cwiseAbs().maxCoeff(&k) > kParallel)) continue;
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

  bool fits(const Aabb& box, int k, double at) const {
    return at > box.lo[k] + kLeastCut * disc_.half && at < box.hi[k] - kLeastCut * disc_.half;
  }

  /// By axis, how clearances change.
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

  /// Across the axis of the greatest weight, of those along which the box is not small already.
  Division halved(const Aabb& box, Vec3 weight) const {
    const Vec3 size = box.size();
    for (int k = 0; k < 3; ++k)
      if (size[k] < kLeastEdge * disc_.half) weight[k] = 0;
    int k = 0;
    (weight.maxCoeff() > 0 ? weight : size).maxCoeff(&k);
    return {k, box.center()[k]};
  }

  const InnerDisc& disc_;
  Facets facets_;
  SolidUnion solids_;
  DiscRoom room_;
  Vec3 start_;
  Aabb box_;
  std::vector<Vec3> normals_;
};

}  // namespace

std::optional<DiscCage> disc_cage(const InnerDisc& disc, const std::vector<Solid>& around, const DiscEffort& effort,
                                  const RunContext& context) {
  const auto cells = Chamber(disc, around).closed(effort, context);
  if (!cells) return std::nullopt;
  return DiscCage{disc, *cells};
}

}  // namespace dismantle::immobility
