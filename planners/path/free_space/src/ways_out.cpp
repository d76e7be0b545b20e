#include "dismantle/free_space/ways_out.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dismantle::free_space {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr std::int32_t kMargin = 3;                       // cells around the box of what stays
constexpr std::uint16_t kFar = 0xffff;                    // not known, or further than it matters
constexpr std::array<std::uint16_t, 3> kThirds{3, 4, 5};  // of a cell: to a neighbour by face, edge, corner
constexpr std::uint32_t kUnit = 3;                        // of cost, a cell that is far from walls
constexpr std::uint32_t kNearWall = 108;  // so much dearer is one at a wall; twice as far from it a quarter of that
constexpr std::uint32_t kInWall = 120;    // cells: so much longer is the way from one that is not free
constexpr double kClosed = 2;             // cells around a narrow place, and its width: so far it is closed
constexpr int kAhead = 3;                 // cells
constexpr std::uint8_t kDeepest = 0xff;

}  // namespace

std::uint32_t WaysOut::id(const Index& i) const {
  return static_cast<std::uint32_t>((i[2] * count_[1] + i[1]) * count_[0] + i[0]);
}

Vec3 WaysOut::center(std::uint32_t cell) const {
  const auto nx = static_cast<std::uint32_t>(count_[0]), ny = static_cast<std::uint32_t>(count_[1]);
  return box_.lo + cell_ * (Vec3(cell % nx, cell / nx % ny, cell / nx / ny) + Vec3::Constant(0.5));
}

std::uint32_t WaysOut::cell_of(const Vec3& p) const {
  if (!box_.contains(p)) return kNone;
  Index i;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    i[k] = std::min(static_cast<std::int32_t>((p[axis] - box_.lo[axis]) / cell_), count_[k] - 1);
  }
  return id(i);
}

bool WaysOut::rim(std::uint32_t cell) const {
  const auto nx = static_cast<std::uint32_t>(count_[0]), ny = static_cast<std::uint32_t>(count_[1]),
             nz = static_cast<std::uint32_t>(count_[2]);
  const std::uint32_t x = cell % nx, y = cell / nx % ny, z = cell / nx / ny;
  return x == 0 || y == 0 || z == 0 || x == nx - 1 || y == ny - 1 || z == nz - 1;
}

/// visit(neighbour, 0 | 1 | 2: by face, edge, corner)
template <typename Visit>
void WaysOut::each_neighbour(std::uint32_t cell, const Visit& visit) const {
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

WaysOut::WaysOut(const Assembly& assembly, const std::vector<PlacedPart>& fixed, double ball, std::size_t most_cells) {
  for (const auto& s : fixed)
    for (const auto& v : assembly.parts[s.part].mesh->vertices) box_.extend(s.pose * v);
  if (box_.empty()) box_.extend(Vec3::Zero());
  // Solved for the edge by repetition: the margin counts, too.
  cell_ = std::cbrt(std::max(box_.size().prod(), 1e-9) / static_cast<double>(most_cells));
  const auto cells = [&](double edge) {
    return (box_.size() / edge + Vec3::Constant(2 * kMargin + 1)).array().floor().prod();
  };
  while (cells(cell_) > static_cast<double>(most_cells)) cell_ *= 1.05;
  std::size_t all = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    count_[k] = static_cast<std::int32_t>(box_.size()[static_cast<Eigen::Index>(k)] / cell_) + 1 + 2 * kMargin;
    all *= static_cast<std::size_t>(count_[k]);
  }
  const Vec3 middle = box_.center(), half = 0.5 * cell_ * Vec3(count_[0], count_[1], count_[2]);
  box_ = {middle - half, middle + half};
  clearance_.assign(all, kFar);
  for (const auto& s : fixed) {
    const Mesh& mesh = *assembly.parts[s.part].mesh;
    for (const auto& t : mesh.triangles)
      mark({s.pose * mesh.vertices[t[0]], s.pose * mesh.vertices[t[1]], s.pose * mesh.vertices[t[2]]});
  }
  measure_clearance();
  least_ = static_cast<std::uint16_t>(std::max(1.0, 3 * (ball / cell_ - 1)));
  find_ways();
  reach_walls();
}

bool WaysOut::close_narrowest(const Vec3& p, double reach) {
  std::uint32_t cell = cell_of(p), narrowest = kNone;
  for (double way = 0; cell != kNone && next_[cell] != kNone && !rim(cell) && way < reach;) {
    if (depth_[cell] == 0 && (narrowest == kNone || clearance_[cell] < clearance_[narrowest])) narrowest = cell;
    way += (center(cell) - center(next_[cell])).norm();
    cell = next_[cell];
  }
  if (narrowest == kNone) return false;
  const double radius = cell_ * (kClosed + clearance_[narrowest] / 3.0);
  std::vector<std::uint32_t> near{narrowest};
  clearance_[narrowest] = 0;
  for (std::size_t k = 0; k < near.size(); ++k)
    each_neighbour(near[k], [&](std::uint32_t to, std::size_t) {
      if (clearance_[to] < least_ || (center(to) - center(narrowest)).norm() > radius) return;
      clearance_[to] = 0;
      near.push_back(to);
    });
  find_ways();
  reach_walls();
  return true;
}

/// All cells that a triangle touches, and perhaps some beside it: column by column along the axis that its plane is
/// steepest to.
void WaysOut::mark(const std::array<Vec3, 3>& corners) {
  std::array<Vec3, 3> c;
  for (std::size_t k = 0; k < 3; ++k) c[k] = (corners[k] - box_.lo) / cell_;
  const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]);
  int up = 0;
  normal.cwiseAbs().maxCoeff(&up);
  const int u = (up + 1) % 3, v = (up + 2) % 3;
  Aabb around;
  for (const auto& p : c) around.extend(p);
  constexpr double kSlack = 1e-6;  // what lies in the face of a cell touches both
  const auto first = [&](double x, int axis) {
    return std::clamp(static_cast<std::int32_t>(std::floor(x - kSlack)), 0, count_[static_cast<std::size_t>(axis)] - 1);
  };
  const auto last = [&](double x, int axis) {
    return std::clamp(static_cast<std::int32_t>(std::floor(x + kSlack)), 0, count_[static_cast<std::size_t>(axis)] - 1);
  };
  // What grows from an edge into the triangle, at most so much below 0 where a column still touches it.
  struct Edge {
    double a, b, c, slack;
  };
  std::array<Edge, 3> edges;
  const double sign = normal[up] < 0 ? -1 : 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &p = c[k], d = c[(k + 1) % 3] - c[k];
    edges[k] = {-sign * d[v], sign * d[u], sign * (d[v] * p[u] - d[u] * p[v]), 0.5 * (std::abs(d[u]) + std::abs(d[v]))};
  }
  const bool flat = std::abs(normal[up]) < 1e-12;  // a line or a point: its box will do
  const double rise_u = flat ? 0 : -normal[u] / normal[up], rise_v = flat ? 0 : -normal[v] / normal[up];
  const double spread = 0.5 * (std::abs(rise_u) + std::abs(rise_v));
  Index i{};
  for (std::int32_t y = first(around.lo[v], v); y <= last(around.hi[v], v); ++y)
    for (std::int32_t x = first(around.lo[u], u); x <= last(around.hi[u], u); ++x) {
      const double mu = x + 0.5, mv = y + 0.5;
      if (!flat && std::any_of(edges.begin(), edges.end(),
                               [&](const Edge& e) { return e.a * mu + e.b * mv + e.c < -e.slack - kSlack; }))
        continue;
      const double z = c[0][up] + rise_u * (mu - c[0][u]) + rise_v * (mv - c[0][v]);
      const double lo = flat ? around.lo[up] : std::max(around.lo[up], z - spread),
                   hi = flat ? around.hi[up] : std::min(around.hi[up], z + spread);
      i[static_cast<std::size_t>(u)] = x;
      i[static_cast<std::size_t>(v)] = y;
      for (std::int32_t w = first(lo, up); w <= last(hi, up); ++w) {
        i[static_cast<std::size_t>(up)] = w;
        clearance_[id(i)] = 0;
      }
    }
}

/// Chamfer distance, 3-4-5: two sweeps.
void WaysOut::measure_clearance() {
  struct Back {
    std::int32_t x, y, z;
    std::uint16_t thirds;
  };
  std::vector<Back> back;  // neighbours that a forward sweep has seen before
  for (int k = 0; k < 13; ++k) {
    const Back b{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1, 0};
    back.push_back(
        {b.x, b.y, b.z, kThirds[static_cast<std::size_t>(std::abs(b.x) + std::abs(b.y) + std::abs(b.z) - 1)]});
  }
  const auto sweep = [&](int way) {
    const std::size_t all = clearance_.size();
    for (std::size_t n = 0; n < all; ++n) {
      const std::size_t cell = way > 0 ? n : all - 1 - n;
      std::uint16_t& own = clearance_[cell];
      if (own == 0) continue;
      const auto nx = static_cast<std::size_t>(count_[0]), ny = static_cast<std::size_t>(count_[1]);
      const Index at{static_cast<std::int32_t>(cell % nx), static_cast<std::int32_t>(cell / nx % ny),
                     static_cast<std::int32_t>(cell / nx / ny)};
      for (const Back& b : back) {
        const Index to{at[0] + way * b.x, at[1] + way * b.y, at[2] + way * b.z};
        if (to[0] < 0 || to[1] < 0 || to[2] < 0 || to[0] >= count_[0] || to[1] >= count_[1] || to[2] >= count_[2])
          continue;
        const std::uint16_t there = clearance_[id(to)];
        if (there != kFar && there + b.thirds < own) own = static_cast<std::uint16_t>(there + b.thirds);
      }
    }
  };
  sweep(1);
  sweep(-1);
}

/// Dijkstra's algorithm from the rim inwards, waiting cells in buckets of equal cost.
void WaysOut::find_ways() {
  cost_.assign(clearance_.size(), kNone);
  next_.assign(clearance_.size(), kNone);
  length_.assign(clearance_.size(), 0);
  const auto dear = [&](std::uint32_t cell) {
    const std::uint32_t clear = std::clamp<std::uint32_t>(clearance_[cell], 3, 1000);
    return kUnit + 9 * kNearWall / (clear * clear);
  };
  constexpr std::size_t kBuckets = 2 * (kUnit + kNearWall) + 1;  // more than one step may cost
  std::vector<std::vector<std::uint32_t>> waiting(kBuckets);
  std::size_t open = 0;
  for (std::uint32_t cell = 0; cell < cost_.size(); ++cell)
    if (rim(cell)) {
      cost_[cell] = 0;
      next_[cell] = cell;
      waiting[0].push_back(cell);
      ++open;
    }
  for (std::uint32_t cost = 0; open > 0; ++cost) {
    auto& bucket = waiting[cost % kBuckets];
    for (std::size_t k = 0; k < bucket.size(); ++k) {
      const std::uint32_t cell = bucket[k];
      --open;
      if (cost_[cell] != cost) continue;  // a cheaper way was found
      each_neighbour(cell, [&](std::uint32_t to, std::size_t kind) {
        if (clearance_[to] < least_) return;
        const std::uint32_t there = cost + kThirds[kind] * dear(to) / 3;
        if (there >= cost_[to]) return;
        cost_[to] = there;
        next_[to] = cell;
        length_[to] = length_[cell] + static_cast<float>(kThirds[kind]) / 3;
        waiting[there % kBuckets].push_back(to);
        ++open;
      });
    }
    bucket.clear();
  }
}

/// What is not free, or closed in, belongs to the nearest cell with a way; between two, to the dearer: that is how the
/// other side of a thin wall does not attract.
void WaysOut::reach_walls() {
  depth_.assign(cost_.size(), kDeepest);
  std::vector<std::uint32_t> layer, next;
  for (std::uint32_t cell = 0; cell < cost_.size(); ++cell)
    if (cost_[cell] != kNone) {
      depth_[cell] = 0;
      layer.push_back(cell);
    }
  for (std::uint8_t depth = 1; depth < kDeepest && !layer.empty(); ++depth) {
    next.clear();
    for (const std::uint32_t cell : layer)
      each_neighbour(cell, [&](std::uint32_t to, std::size_t) {
        if (depth_[to] != kDeepest) return;
        depth_[to] = depth;
        next.push_back(to);
      });
    for (const std::uint32_t cell : next) {
      std::size_t nearest = kThirds.size();
      each_neighbour(cell, [&](std::uint32_t to, std::size_t kind) {
        if (depth_[to] + 1 != depth || kind > nearest) return;
        if (kind == nearest && cost_[to] <= cost_[next_[cell]]) return;
        nearest = kind;
        next_[cell] = to;
      });
      cost_[cell] = cost_[next_[cell]] + 1;
      length_[cell] = length_[next_[cell]] + kInWall * kThirds[nearest] / 3.0F;
    }
    layer.swap(next);
  }
}

unsigned WaysOut::depth(const Vec3& p) const {
  const std::uint32_t cell = cell_of(p);
  return cell == kNone ? 0 : depth_[cell];
}

std::vector<Vec3> WaysOut::way(const Vec3& p) const {
  std::vector<Vec3> middles;
  std::uint32_t cell = cell_of(p);
  if (cell == kNone) return middles;
  for (; next_[cell] != kNone && next_[cell] != cell; cell = next_[cell]) middles.push_back(center(cell));
  middles.push_back(center(cell));
  return middles;
}

std::uint32_t WaysOut::ahead_of(std::uint32_t cell) const {
  for (int k = 0; k < kAhead; ++k) cell = next_[cell];
  return cell;
}

Vec3 WaysOut::ahead(const Vec3& p) const {
  const std::uint32_t cell = cell_of(p);
  if (cell != kNone && next_[cell] != kNone) {
    const std::uint32_t to = ahead_of(cell);
    if (!rim(to)) return center(to);
  }
  // Straight out, by the nearest face of the box.
  Vec3 out = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
    for (const int side : {-1, 1}) {
      const double way = side < 0 ? p[k] - box_.lo[k] : box_.hi[k] - p[k];
      if (way >= least) continue;
      least = way;
      out = side * Vec3::Unit(k);
    }
  return p + kAhead * cell_ * out;
}

double WaysOut::length(const Vec3& p) const {
  const std::uint32_t cell = cell_of(p);
  if (cell == kNone) return -std::sqrt(box_.squared_distance(p));
  if (next_[cell] == kNone) return box_.size().sum();
  const std::uint32_t to = ahead_of(cell);
  if (to == cell) return 0;
  const double longer = static_cast<double>(length_[cell] - length_[to]) / (center(cell) - center(to)).norm();
  return cell_ * static_cast<double>(length_[to]) + cell_ * longer * (p - center(to)).norm();
}

}  // namespace dismantle::free_space
