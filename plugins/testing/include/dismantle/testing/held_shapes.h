/// Pairs that hold each other without overlap, and similar pairs that do not.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "dismantle/testing/shapes.h"

namespace dismantle::shapes {

/// Solid of revolution about z of a closed outline (radius > 0, height), counter-clockwise in the (r, z) half-plane.
/// Covers `share` of a turn, with flat ends if that is less than 1.
inline Mesh lathe(const std::vector<std::pair<double, double>>& outline, int around, double share = 1,
                  const std::vector<Triangle>& end = {}) {
  Mesh m;
  const auto n = static_cast<std::uint32_t>(outline.size());
  const auto rows = static_cast<std::uint32_t>(share < 1 ? around + 1 : around);
  for (std::uint32_t i = 0; i < rows; ++i) {
    const double a = share * 2 * std::numbers::pi * i / around;
    for (const auto& [r, z] : outline) m.vertices.emplace_back(r * std::cos(a), r * std::sin(a), z);
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(around); ++i)
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t j = (i + 1) % rows, l = (k + 1) % n;
      m.triangles.push_back({i * n + k, j * n + k, j * n + l});
      m.triangles.push_back({i * n + k, j * n + l, i * n + l});
    }
  if (share < 1)
    for (const Triangle& t : end) {
      m.triangles.push_back(t);
      const std::uint32_t last = (rows - 1) * n;
      m.triangles.push_back({last + t[0], last + t[2], last + t[1]});
    }
  if (volume(m) < 0)
    for (auto& t : m.triangles) std::swap(t[1], t[2]);
  return m;
}

/// A can about z: a cavity with radius `cavity` about the origin, walls 0.3 thick, round openings of radius `below` and
/// `above`. With `share` < 1 its side is open.
inline Mesh can(double cavity, double height, double below, double above, double share = 1) {
  const double h = 0.5 * height, r = cavity + 0.3;
  return lathe({{below, -h - 0.3},
                {r, -h - 0.3},
                {r, h + 0.3},
                {above, h + 0.3},
                {above, h},
                {cavity, h},
                {cavity, -h},
                {below, -h}},
               48, share, {{0, 1, 7}, {1, 6, 7}, {1, 2, 6}, {2, 5, 6}, {2, 3, 5}, {3, 4, 5}});
}

/// The same can over a full turn, with a window in its side over `sectors` of 48 sectors, as high as the cavity.
inline Mesh can_with_window(double cavity, double height, double below, double above, std::uint32_t sectors) {
  Mesh m = can(cavity, height, below, above);
  const auto at = [](std::uint32_t sector, std::uint32_t corner) { return 8 * (sector % 48) + corner; };
  const auto wall =
      [&](const Triangle& t) {  // in the window: triangle of the outer (corners 1, 2) or inner wall (5, 6)
        const auto in = [&](std::uint32_t v) { return v / 8 <= sectors; };
        const auto of = [&](std::uint32_t a, std::uint32_t b) {
          return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return v % 8 == a || v % 8 == b; });
        };
        return (of(1, 2) || of(5, 6)) && std::all_of(t.begin(), t.end(), in);
      };
  // The first triangle of the outer wall shows the orientation of the mesh.
  const auto first = std::find_if(m.triangles.begin(), m.triangles.end(), wall);
  const bool flipped = (*first)[1] != at(1, (*first)[0] % 8) && (*first)[2] == at(1, (*first)[0] % 8);
  std::erase_if(m.triangles, wall);
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    for (Triangle t : {Triangle{a, b, c}, Triangle{a, c, d}}) {
      if (flipped) std::swap(t[1], t[2]);
      m.triangles.push_back(t);
    }
  };
  for (std::uint32_t i = 0; i < sectors; ++i) {
    quad(at(i + 1, 2), at(i, 2), at(i, 5), at(i + 1, 5));
    quad(at(i, 1), at(i + 1, 1), at(i + 1, 6), at(i, 6));
  }
  quad(at(0, 2), at(0, 1), at(0, 6), at(0, 5));
  quad(at(sectors, 1), at(sectors, 2), at(sectors, 5), at(sectors, 6));
  return m;
}

/// Bar of square section (edge 2 * half) along a line in the plane y = 0, mitred at its bends.
inline Mesh bent_bar(const std::vector<Vec3>& line, double half) {
  Mesh m;
  const std::size_t n = line.size();
  const auto across = [](const Vec3& d) { return Vec3(-d.z(), 0, d.x()); };
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 in = (line[k == 0 ? 1 : k] - line[k == 0 ? 0 : k - 1]).normalized();
    const Vec3 out = k + 1 < n ? Vec3((line[k + 1] - line[k]).normalized()) : in;
    const Vec3 middle = (across(in) + across(out)).normalized();
    const Vec3 side = half / middle.dot(across(in)) * middle, y(0, half, 0);
    for (const Vec3& p : {Vec3(side + y), Vec3(-side + y), Vec3(-side - y), Vec3(side - y)})
      m.vertices.push_back(line[k] + p);
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    m.triangles.push_back({a, b, c});
    m.triangles.push_back({a, c, d});
  };
  for (std::uint32_t k = 0; k + 1 < n; ++k)
    for (std::uint32_t i = 0; i < 4; ++i) quad(4 * k + i, 4 * k + (i + 1) % 4, 4 * k + 4 + (i + 1) % 4, 4 * k + 4 + i);
  const auto last = static_cast<std::uint32_t>(4 * n - 4);
  quad(3, 2, 1, 0);
  quad(last, last + 1, last + 2, last + 3);
  if (volume(m) < 0)
    for (auto& t : m.triangles) std::swap(t[1], t[2]);
  return m;
}

/// A line through a hole in the plane z = 0, from `below` up to `above`; either end is bent aside (rad; 0 = no bend).
inline std::vector<Vec3> crank(double below, double above, double bend_below, double bend_above, double legs) {
  std::vector<Vec3> line;
  if (bend_below > 0) line.push_back(Vec3(0, 0, below) - legs * Vec3(std::sin(bend_below), 0, std::cos(bend_below)));
  line.emplace_back(0, 0, below);
  line.emplace_back(0, 0, above);
  if (bend_above > 0) line.push_back(Vec3(0, 0, above) + legs * Vec3(std::sin(bend_above), 0, std::cos(bend_above)));
  return line;
}

/// Round plate about the origin with a round hole.
inline Mesh plate(double hole, double thickness) { return tube(hole, 2, -0.5 * thickness, 0.5 * thickness, 40); }

/// A block in a case whose open top has a rim.
struct Cased {
  Vec3 half;         ///< of the block, about the origin
  double play = 0;   ///< clearance on every side
  double rim = 0;    ///< overhang: opening narrower than the block by this on every side; < 0: wider
  double thick = 0;  ///< thickness of the rim

  Mesh block() const { return box(-half, half); }
  Mesh around() const {
    const Vec3 in = half.array() + play, out = in.array() + 0.3;
    const double top = in.z(), x = half.x() - rim, y = half.y() - rim;
    Mesh m = box({-out.x(), -out.y(), -out.z()}, {out.x(), out.y(), -in.z()});
    for (const double s : {-1.0, 1.0}) {
      const auto wall = [&](Vec3 a, Vec3 b) { append(m, box(a.cwiseMin(b), a.cwiseMax(b))); };
      wall({s * in.x(), -out.y(), -in.z()}, {s * out.x(), out.y(), top + thick});
      wall({-in.x(), s * in.y(), -in.z()}, {in.x(), s * out.y(), top + thick});
      wall({s * std::min(x, in.x()), -in.y(), top}, {s * in.x(), in.y(), top + thick});
      wall({-in.x(), s * std::min(y, in.y()), top}, {in.x(), s * in.y(), top + thick});
    }
    return m;
  }
};

/// A tray with a slab in one half, under a roof, and a block in the other half, under the slab's tongue. Slab and block
/// each hold the other in place.
struct Keyed {
  double length = 0.6, width = 0.4, height = 0.4;  ///< of one half: the size of the slab and of the block
  double tongue = 0.3;
  double play = 0.01;   ///< clearance everywhere
  double roofed = 0.4;  ///< roofed part of the slab's length
  double gap = 0;       ///< behind the block, in addition to the play

  Mesh slab() const {
    Mesh m = box({-length, 0, 0}, {0, width, height});
    append(m, box({0, 0, 0.5 * height}, {tongue, width, height}));
    return m;
  }
  Mesh block() const {
    Mesh m = box({play, 0, 0}, {length, width, 0.5 * height - play});
    append(m, box({tongue + play, 0, 0.5 * height - play}, {length, width, height}));
    return m;
  }
  Mesh tray() const {
    const double wall = 0.2, x0 = -length - play, x1 = length + play + gap, y0 = -play, y1 = width + play;
    const double top = height + play;
    Mesh m = box({x0 - wall, y0 - wall, -play - wall}, {x1 + wall, y1 + wall, -play});
    append(m, box({x0 - wall, y0 - wall, -play}, {x0, y1 + wall, top}));
    append(m, box({x1, y0 - wall, -play}, {x1 + wall, y1 + wall, top}));
    append(m, box({x0, y0 - wall, -play}, {x1, y0, top}));
    append(m, box({x0, y1, -play}, {x1, y1 + wall, top}));
    if (roofed > 0) append(m, box({x0 - wall, y0 - wall, top}, {roofed - length, y1 + wall, top + wall}));
    return m;
  }
};

/// A cube about the origin in a block with a passage that is wider by `play` on every side. The passage leads along x,
/// then along y, by one cube each, and optionally up and out. The block is one solid; its surface follows a grid.
struct Passage {
  double half = 0.2, play = 0.01;
  bool open = false;

  double step() const { return 2 * (half + play); }
  Mesh cube() const { return box(Vec3::Constant(-half), Vec3::Constant(half)); }
  bool solid(const std::array<int, 3>& at) const {
    const auto [x, y, z] = at;
    if (std::min({x, y, z}) < -1 || x > 2 || y > 2 || z > 1) return false;
    const bool corner = x == 1 && y == 1;
    if (z == 0 && (corner || (y == 0 && (x == 0 || x == 1)))) return false;
    return !(open && z == 1 && corner);
  }
  Mesh around() const {
    Mesh m;
    std::map<std::array<int, 3>, std::uint32_t> known;
    const auto vertex = [&](const std::array<int, 3>& at) {
      const auto [found, is_new] = known.try_emplace(at, static_cast<std::uint32_t>(m.vertices.size()));
      if (is_new) m.vertices.push_back(step() * (Vec3(at[0], at[1], at[2]) - Vec3::Constant(0.5)));
      return found->second;
    };
    for (int x = -1; x <= 2; ++x)
      for (int y = -1; y <= 2; ++y)
        for (int z = -1; z <= 1; ++z)
          for (std::size_t d = 0; d < 3 && solid({x, y, z}); ++d)
            for (const int side : {0, 1}) {
              std::array<int, 3> at{x, y, z};
              at[d] += 2 * side - 1;
              if (solid(at)) continue;
              at[d] += 1 - side;
              // Corners are counter-clockwise seen from outside.
              const std::size_t u = (d + (side ? 1 : 2)) % 3, v = (d + (side ? 2 : 1)) % 3;
              std::array<int, 3> b = at, c = at, e = at;
              ++b[u], ++c[u], ++c[v], ++e[v];
              m.triangles.push_back({vertex(at), vertex(b), vertex(c)});
              m.triangles.push_back({vertex(at), vertex(c), vertex(e)});
            }
    return m;
  }
};

}  // namespace dismantle::shapes
