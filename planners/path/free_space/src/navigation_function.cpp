#include "dismantle/free_space/navigation_function.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dismantle/geometry/face_axes.h"
#include "dismantle/path/placed_parts.h"

namespace dismantle::free_space {
namespace {

using Vec3 = Eigen::Vector3d;

/// Cells between a point and its lookahead: enough to smooth the directions of single cells. The margin around the
/// fixed parts is as wide, so that a route along their box is smoothed as well.
constexpr int kLookahead = 3;
/// Chamfer distances 3-4-5, in thirds of a cell: to a neighbour by face, edge and corner (Borgefors 1986).
constexpr std::array<std::uint16_t, 3> kThirds{3, 4, 5};
const auto unknown_clearance = std::numeric_limits<std::uint16_t>::max();
const auto unreached = std::numeric_limits<std::uint8_t>::max();

}  // namespace

std::uint32_t NavigationFunction::id(const Index& i) const {
  return static_cast<std::uint32_t>((i[2] * count_[1] + i[1]) * count_[0] + i[0]);
}

Vec3 NavigationFunction::center(std::uint32_t cell) const {
  const auto nx = static_cast<std::uint32_t>(count_[0]), ny = static_cast<std::uint32_t>(count_[1]);
  return box_.lo + cell_ * (Vec3(cell % nx, cell / nx % ny, cell / nx / ny) + Vec3::Constant(0.5));
}

std::uint32_t NavigationFunction::cell_of(const Vec3& p) const {
  if (!box_.contains(p)) return geometry::kNoIndex;
  Index i;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    i[k] = std::min(static_cast<std::int32_t>((p[axis] - box_.lo[axis]) / cell_), count_[k] - 1);
  }
  return id(i);
}

bool NavigationFunction::on_boundary(std::uint32_t cell) const {
  const auto nx = static_cast<std::uint32_t>(count_[0]), ny = static_cast<std::uint32_t>(count_[1]),
             nz = static_cast<std::uint32_t>(count_[2]);
  const std::uint32_t x = cell % nx, y = cell / nx % ny, z = cell / nx / ny;
  return x == 0 || y == 0 || z == 0 || x == nx - 1 || y == ny - 1 || z == nz - 1;
}

/// visit(neighbour, 0 | 1 | 2: by face, edge, corner)
template <typename Visit>
void NavigationFunction::for_each_neighbour(std::uint32_t cell, const Visit& visit) const {
  const auto nx = static_cast<std::uint32_t>(count_[0]), ny = static_cast<std::uint32_t>(count_[1]);
  const Index at{static_cast<std::int32_t>(cell % nx), static_cast<std::int32_t>(cell / nx % ny),
                 static_cast<std::int32_t>(cell / nx / ny)};
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int kind = std::abs(dx) + std::abs(dy) + std::abs(dz) - 1;
        const Index to{at[0] + dx, at[1] + dy, at[2] + dz};
        if (kind < 0 || to[0] < 0 || to[1] < 0 || to[2] < 0 || to[0] >= count_[0] || to[1] >= count_[1] ||
            to[2] >= count_[2])
          continue;
        visit(id(to), static_cast<std::size_t>(kind));
      }
}

NavigationFunction::NavigationFunction(const Assembly& assembly, const std::vector<PlacedPart>& fixed, double ball,
                                       const GridParameters& parameters)
    : wall_cost_(static_cast<std::uint32_t>(parameters.wall_cost)),
      blocked_length_(static_cast<float>(parameters.blocked_length)) {
  box_ = path::box_of(assembly, fixed);
  if (box_.empty()) box_.extend(Vec3::Zero());
  // The cells of the margin count as well, so the edge is found by iteration.
  const auto most_cells = static_cast<double>(parameters.cells);
  cell_ = std::cbrt(std::max(box_.size().prod(), 1e-9) / most_cells);
  const auto cells = [&](double edge) {
    return (box_.size() / edge + Vec3::Constant(2 * kLookahead + 1)).array().floor().prod();
  };
  while (cells(cell_) > most_cells) cell_ *= 1.05;
  std::size_t all = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    count_[k] = static_cast<std::int32_t>(box_.size()[static_cast<Eigen::Index>(k)] / cell_) + 1 + 2 * kLookahead;
    all *= static_cast<std::size_t>(count_[k]);
  }
  const Vec3 middle = box_.center(), half = 0.5 * cell_ * Vec3(count_[0], count_[1], count_[2]);
  box_ = {middle - half, middle + half};
  clearance_.assign(all, unknown_clearance);
  for (const auto& s : fixed) {
    const Mesh& mesh = *assembly.parts[s.part].mesh;
    for (const auto& t : mesh.triangles)
      rasterize({s.pose * mesh.vertices[t[0]], s.pose * mesh.vertices[t[1]], s.pose * mesh.vertices[t[2]]});
  }
  compute_clearance();
  min_clearance_ = static_cast<std::uint16_t>(std::max(1.0, 3 * (ball / cell_ - 1)));
  compute_routes();
  extend_into_walls();
}

bool NavigationFunction::close_narrowest(const Vec3& p, double reach) {
  std::uint32_t cell = cell_of(p), narrowest = geometry::kNoIndex;
  for (double length = 0;
       cell != geometry::kNoIndex && next_[cell] != geometry::kNoIndex && !on_boundary(cell) && length < reach;) {
    if (cells_to_route_[cell] == 0 && (narrowest == geometry::kNoIndex || clearance_[cell] < clearance_[narrowest]))
      narrowest = cell;
    length += (center(cell) - center(next_[cell])).norm();
    cell = next_[cell];
  }
  if (narrowest == geometry::kNoIndex) return false;
  // Two cells wider than the place itself, so that no diagonal gap stays open.
  const double radius = cell_ * (2 + clearance_[narrowest] / 3.0);
  std::vector<std::uint32_t> near{narrowest};
  clearance_[narrowest] = 0;
  for (std::size_t k = 0; k < near.size(); ++k)
    for_each_neighbour(near[k], [&](std::uint32_t to, std::size_t) {
      if (clearance_[to] < min_clearance_ || (center(to) - center(narrowest)).norm() > radius) return;
      clearance_[to] = 0;
      near.push_back(to);
    });
  compute_routes();
  extend_into_walls();
  return true;
}

/// Marks all cells that a triangle touches, and perhaps some beside it. Goes column by column along the axis that is
/// closest to the triangle's normal.
void NavigationFunction::rasterize(const std::array<Vec3, 3>& corners) {
  std::array<Vec3, 3> c;
  for (std::size_t k = 0; k < 3; ++k) c[k] = (corners[k] - box_.lo) / cell_;
  const Vec3 normal = geometry::area_vector(c);
  int up = 0;
  normal.cwiseAbs().maxCoeff(&up);
  const int u = (up + 1) % 3, v = (up + 2) % 3;
  Aabb around;
  for (const auto& p : c) around.extend(p);
  // A surface in the face between two cells touches both, despite rounding.
  const double rounding = geometry::kRounding * (count_[0] + count_[1] + count_[2]);  // cells
  const auto first = [&](double x, int axis) {
    return std::clamp(static_cast<std::int32_t>(std::floor(x - rounding)), 0,
                      count_[static_cast<std::size_t>(axis)] - 1);
  };
  const auto last = [&](double x, int axis) {
    return std::clamp(static_cast<std::int32_t>(std::floor(x + rounding)), 0,
                      count_[static_cast<std::size_t>(axis)] - 1);
  };
  // A linear function that grows from an edge into the triangle. A column still touches the triangle where the function
  // is above -slack.
  struct Edge {
    double a, b, c, slack;
  };
  std::array<Edge, 3> edges;
  const double sign = normal[up] < 0 ? -1 : 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &p = c[k], d = c[(k + 1) % 3] - c[k];
    edges[k] = {-sign * d[v], sign * d[u], sign * (d[v] * p[u] - d[u] * p[v]), 0.5 * (std::abs(d[u]) + std::abs(d[v]))};
  }
  const bool degenerate = std::abs(normal[up]) < 1e-12;  // a line or a point: all cells of its box are marked
  const double rise_u = degenerate ? 0 : -normal[u] / normal[up], rise_v = degenerate ? 0 : -normal[v] / normal[up];
  const double spread = 0.5 * (std::abs(rise_u) + std::abs(rise_v));
  Index i{};
  for (std::int32_t y = first(around.lo[v], v); y <= last(around.hi[v], v); ++y)
    for (std::int32_t x = first(around.lo[u], u); x <= last(around.hi[u], u); ++x) {
      const double mu = x + 0.5, mv = y + 0.5;
      if (!degenerate && std::any_of(edges.begin(), edges.end(),
                                     [&](const Edge& e) { return e.a * mu + e.b * mv + e.c < -e.slack - rounding; }))
        continue;
      const double z = c[0][up] + rise_u * (mu - c[0][u]) + rise_v * (mv - c[0][v]);
      const double lo = degenerate ? around.lo[up] : std::max(around.lo[up], z - spread),
                   hi = degenerate ? around.hi[up] : std::min(around.hi[up], z + spread);
      i[static_cast<std::size_t>(u)] = x;
      i[static_cast<std::size_t>(v)] = y;
      for (std::int32_t w = first(lo, up); w <= last(hi, up); ++w) {
        i[static_cast<std::size_t>(up)] = w;
        clearance_[id(i)] = 0;
      }
    }
}

/// Chamfer distance in two sweeps.
void NavigationFunction::compute_clearance() {
  struct Back {
    std::int32_t x, y, z;
    std::uint16_t thirds;
  };
  std::vector<Back> back;  // neighbours that a forward sweep visits before the cell
  for (int k = 0; k < 13; ++k) {
    const Back b{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1, 0};
    back.push_back(
        {b.x, b.y, b.z, kThirds[static_cast<std::size_t>(std::abs(b.x) + std::abs(b.y) + std::abs(b.z) - 1)]});
  }
  const auto sweep = [&](int direction) {
    const std::size_t all = clearance_.size();
    for (std::size_t n = 0; n < all; ++n) {
      const std::size_t cell = direction > 0 ? n : all - 1 - n;
      std::uint16_t& own = clearance_[cell];
      if (own == 0) continue;
      const auto nx = static_cast<std::size_t>(count_[0]), ny = static_cast<std::size_t>(count_[1]);
      const Index at{static_cast<std::int32_t>(cell % nx), static_cast<std::int32_t>(cell / nx % ny),
                     static_cast<std::int32_t>(cell / nx / ny)};
      for (const Back& b : back) {
        const Index to{at[0] + direction * b.x, at[1] + direction * b.y, at[2] + direction * b.z};
        if (to[0] < 0 || to[1] < 0 || to[2] < 0 || to[0] >= count_[0] || to[1] >= count_[1] || to[2] >= count_[2])
          continue;
        const std::uint16_t there = clearance_[id(to)];
        if (there != unknown_clearance && there + b.thirds < own) own = static_cast<std::uint16_t>(there + b.thirds);
      }
    }
  };
  sweep(1);
  sweep(-1);
}

/// Dijkstra's algorithm from the boundary inwards. Open cells wait in buckets of equal cost (Dial 1969).
void NavigationFunction::compute_routes() {
  cost_.assign(clearance_.size(), geometry::kNoIndex);
  next_.assign(clearance_.size(), geometry::kNoIndex);
  length_.assign(clearance_.size(), 0);
  // Cost of a cell, in thirds: 3, plus a cost near walls by the inverse square of the clearance.
  const auto cell_cost = [&](std::uint32_t cell) {
    const std::uint32_t clear = std::clamp<std::uint32_t>(clearance_[cell], 3, 1000);
    return 3 + 27 * wall_cost_ / (clear * clear);
  };
  const std::size_t buckets = 2 * (3 + 3 * std::size_t{wall_cost_}) + 1;  // one step always costs less
  std::vector<std::vector<std::uint32_t>> waiting(buckets);
  std::size_t open = 0;
  for (std::uint32_t cell = 0; cell < cost_.size(); ++cell)
    if (on_boundary(cell)) {
      cost_[cell] = 0;
      next_[cell] = cell;
      waiting[0].push_back(cell);
      ++open;
    }
  for (std::uint32_t cost = 0; open > 0; ++cost) {
    auto& bucket = waiting[cost % buckets];
    for (std::size_t k = 0; k < bucket.size(); ++k) {
      const std::uint32_t cell = bucket[k];
      --open;
      if (cost_[cell] != cost) continue;  // a cheaper route was found
      for_each_neighbour(cell, [&](std::uint32_t to, std::size_t kind) {
        if (clearance_[to] < min_clearance_) return;
        const std::uint32_t there = cost + kThirds[kind] * cell_cost(to) / 3;
        if (there >= cost_[to]) return;
        cost_[to] = there;
        next_[to] = cell;
        length_[to] = length_[cell] + static_cast<float>(kThirds[kind]) / 3;
        waiting[there % buckets].push_back(to);
        ++open;
      });
    }
    bucket.clear();
  }
}

/// Each cell without a route is assigned to the nearest cell with one. If two are equally near, the one with the longer
/// route is chosen: otherwise a point within a thin wall would be attracted to the far side.
void NavigationFunction::extend_into_walls() {
  cells_to_route_.assign(cost_.size(), unreached);
  std::vector<std::uint32_t> layer, next;
  for (std::uint32_t cell = 0; cell < cost_.size(); ++cell)
    if (cost_[cell] != geometry::kNoIndex) {
      cells_to_route_[cell] = 0;
      layer.push_back(cell);
    }
  for (std::uint8_t depth = 1; depth < unreached && !layer.empty(); ++depth) {
    next.clear();
    for (const std::uint32_t cell : layer)
      for_each_neighbour(cell, [&](std::uint32_t to, std::size_t) {
        if (cells_to_route_[to] != unreached) return;
        cells_to_route_[to] = depth;
        next.push_back(to);
      });
    for (const std::uint32_t cell : next) {
      std::size_t nearest = kThirds.size();
      for_each_neighbour(cell, [&](std::uint32_t to, std::size_t kind) {
        if (cells_to_route_[to] + 1 != depth || kind > nearest) return;
        if (kind == nearest && cost_[to] <= cost_[next_[cell]]) return;
        nearest = kind;
        next_[cell] = to;
      });
      cost_[cell] = cost_[next_[cell]] + 1;
      length_[cell] = length_[next_[cell]] + blocked_length_ * static_cast<float>(kThirds[nearest]) / 3;
    }
    layer.swap(next);
  }
}

unsigned NavigationFunction::cells_to_route(const Vec3& p) const {
  const std::uint32_t cell = cell_of(p);
  return cell == geometry::kNoIndex ? 0 : cells_to_route_[cell];
}

std::vector<Vec3> NavigationFunction::route(const Vec3& p) const {
  std::vector<Vec3> centers;
  std::uint32_t cell = cell_of(p);
  if (cell == geometry::kNoIndex) return centers;
  for (; next_[cell] != geometry::kNoIndex && next_[cell] != cell; cell = next_[cell]) centers.push_back(center(cell));
  centers.push_back(center(cell));
  return centers;
}

std::uint32_t NavigationFunction::lookahead_of(std::uint32_t cell) const {
  for (int k = 0; k < kLookahead; ++k) cell = next_[cell];
  return cell;
}

Vec3 NavigationFunction::lookahead(const Vec3& p) const {
  const std::uint32_t cell = cell_of(p);
  if (cell != geometry::kNoIndex && next_[cell] != geometry::kNoIndex) {
    const std::uint32_t to = lookahead_of(cell);
    if (!on_boundary(to)) return center(to);
  }
  // Outside, or almost: straight out through the nearest face of the box.
  Vec3 out = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
    for (const int side : {-1, 1}) {
      const double distance = side < 0 ? p[k] - box_.lo[k] : box_.hi[k] - p[k];
      if (distance >= least) continue;
      least = distance;
      out = side * Vec3::Unit(k);
    }
  return p + kLookahead * cell_ * out;
}

double NavigationFunction::remaining(const Vec3& p) const {
  const std::uint32_t cell = cell_of(p);
  if (cell == geometry::kNoIndex) return -std::sqrt(box_.squared_distance(p));
  if (next_[cell] == geometry::kNoIndex) return box_.size().sum();
  const std::uint32_t to = lookahead_of(cell);
  if (to == cell) return 0;
  // Interpolated between the two cells: the length falls continuously as the point moves towards its lookahead.
  const double slope = static_cast<double>(length_[cell] - length_[to]) / (center(cell) - center(to)).norm();
  return cell_ * static_cast<double>(length_[to]) + cell_ * slope * (p - center(to)).norm();
}

}  // namespace dismantle::free_space
