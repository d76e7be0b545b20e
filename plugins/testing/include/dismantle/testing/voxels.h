/// Puzzles made of cubes that touch without play, and a solver that tries everything.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "dismantle/mesh.h"
#include "dismantle/run_context.h"

namespace dismantle::voxels {

/// Indices of a cell along x, y and z.
using Cell = std::array<int, 3>;
using Piece = std::vector<Cell>;  ///< ascending

/// The cell that is `steps` further along an axis.
inline Cell moved(const Cell& c, int axis, int steps) {
  Cell to = c;
  to[static_cast<std::size_t>(axis)] += steps;
  return to;
}

/// The surface of unit cubes, with common corners: cubes that are joined diagonally touch along a pinched edge.
inline Mesh surface(const Piece& piece) {
  const std::set<Cell> cells(piece.begin(), piece.end());
  std::map<Cell, std::uint32_t> corners;
  Mesh mesh;
  const auto corner = [&](const Cell& c) {
    const auto [entry, is_new] = corners.try_emplace(c, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.emplace_back(c[0], c[1], c[2]);
    return entry->second;
  };
  for (const Cell& c : cells)
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1}) {
        if (cells.contains(moved(c, axis, side == 0 ? -1 : 1))) continue;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const Cell a = moved(c, axis, side);
        const std::array<std::uint32_t, 4> q{corner(a), corner(moved(a, u, 1)), corner(moved(moved(a, u, 1), v, 1)),
                                             corner(moved(a, v, 1))};
        if (side == 1)
          mesh.triangles.insert(mesh.triangles.end(), {{q[0], q[1], q[2]}, {q[0], q[2], q[3]}});
        else
          mesh.triangles.insert(mesh.triangles.end(), {{q[0], q[2], q[1]}, {q[0], q[3], q[2]}});
      }
  return mesh;
}

/// A box of cells divided at random among pieces, each connected over faces.
inline std::vector<Piece> random_pieces(Rng& rng, const Cell& size, std::size_t count) {
  std::map<Cell, std::size_t> owner;
  std::vector<Cell> free;
  for (int x = 0; x < size[0]; ++x)
    for (int y = 0; y < size[1]; ++y)
      for (int z = 0; z < size[2]; ++z) free.push_back({x, y, z});
  for (std::size_t k = 0; k < count;)
    if (owner.try_emplace(free[rng.below(free.size())], k).second) ++k;
  while (owner.size() < free.size()) {
    const Cell c = free[rng.below(free.size())];
    const Cell next = moved(c, static_cast<int>(rng.below(3)), rng.below(2) == 0 ? 1 : -1);
    if (const auto own = owner.find(next); own != owner.end()) owner.try_emplace(c, own->second);
  }
  std::vector<Piece> pieces(count);
  for (const auto& [cell, k] : owner) pieces[k].push_back(cell);
  return pieces;
}

/// What the solver that tries everything found.
struct Solution {
  std::optional<int> moves;        ///< slides until a group leaves, that one included; none: nothing can leave
  std::size_t arrangements = 0;    ///< reached; all of them if nothing can leave
};

/// Tries every subset of the pieces, every axis and every length, breadth first; one cell at a time.
inline Solution solve(const std::vector<Piece>& pieces, std::size_t most = 20'000) {
  using Shifts = std::vector<Cell>;
  const std::size_t n = pieces.size();
  const auto collide = [&](const Shifts& at) {
    std::set<Cell> taken;
    for (std::size_t i = 0; i < n; ++i)
      for (Cell c : pieces[i]) {
        for (std::size_t k = 0; k < 3; ++k) c[k] += at[i][k];
        if (!taken.insert(c).second) return true;
      }
    return false;
  };
  std::map<Shifts, int> moves{{Shifts(n, Cell{}), 0}};
  std::vector<Shifts> queue{Shifts(n, Cell{})};
  int size = 0;
  for (const Piece& piece : pieces)
    for (const Cell& c : piece) size = std::max({size, c[0] + 1, c[1] + 1, c[2] + 1});
  for (std::size_t k = 0; k < queue.size() && queue.size() < most; ++k)
    for (std::uint64_t set = 1; set + 1 < std::uint64_t{1} << n; set += 2)  // the first piece moves: the rest is relative
      for (int axis = 0; axis < 3; ++axis)
        for (const int sign : {1, -1}) {
          Shifts at = queue[k];
          for (int steps = 1;; ++steps) {
            for (std::size_t i = 0; i < n; ++i)
              if (set >> i & 1) at[i] = moved(at[i], axis, sign);
            if (collide(at)) break;
            if (steps > 4 * size) return {moves[queue[k]] + 1, queue.size()};
            Shifts key = at;
            for (Cell& c : key)
              for (std::size_t d = 0; d < 3; ++d) c[d] -= at[0][d];
            if (moves.try_emplace(key, moves[queue[k]] + 1).second) queue.push_back(key);
          }
        }
  return {std::nullopt, queue.size()};
}

}  // namespace dismantle::voxels
