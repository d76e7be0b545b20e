/// Assemblies of blocks on a lattice, and what brute force says of them.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/constraints.h"
#include "dismantle/part_set.h"
#include "dismantle/run_context.h"
#include "dismantle/testing/fake_planning.h"

namespace dismantle::fake {

/// A block on a lattice that was cut into boxes. With `angular`, some parts are several of them. With `tub`, the last
/// part stands around them, open at the top, where it may cover some of them; it never moves.
struct Lattice {
  using Corner = std::array<int, 3>;  ///< a cell, or a corner of cells
  static constexpr int kSize = 5;
  std::map<Corner, PartId> cells;
  std::vector<std::vector<Box>> boxes;  // by part
  PartId parts = 0;
  Constraints constraints;

  static Lattice random(Rng& rng, bool angular, bool tub) {
    Lattice lattice;
    lattice.parts = tub ? 7 - static_cast<PartId>(rng.below(2)) : 3 + static_cast<PartId>(rng.below(6));
    std::vector<std::pair<Corner, Corner>> all{{{0, 0, 0}, {kSize, kSize, kSize}}};
    const std::size_t count = angular ? lattice.parts + 1 + rng.below(6) : lattice.parts;
    while (all.size() < count) {
      const std::size_t which = rng.below(all.size()), axis = std::min<std::uint64_t>(rng.below(5), 2);
      const int lo = all[which].first[axis], hi = all[which].second[axis];
      if (hi - lo < 2) continue;
      const int cut = lo + 1 + static_cast<int>(rng.below(static_cast<std::uint64_t>(hi - lo - 1)));
      all.push_back(all[which]);
      all[which].second[axis] = all.back().first[axis] = cut;
    }
    lattice.boxes.resize(lattice.parts);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const PartId part = k < lattice.parts ? static_cast<PartId>(k) : static_cast<PartId>(rng.below(lattice.parts));
      lattice.add(part, all[k].first, all[k].second);
    }
    if (!tub) return lattice;
    constexpr int n = kSize;
    const PartId part = lattice.parts++;
    lattice.boxes.emplace_back();
    lattice.constraints.base = {part};
    lattice.add(part, {-1, -1, -1}, {n + 1, n + 1, 0});
    lattice.add(part, {-1, -1, 0}, {0, n + 1, n});
    lattice.add(part, {n, -1, 0}, {n + 1, n + 1, n});
    lattice.add(part, {0, -1, 0}, {n, 0, n});
    lattice.add(part, {0, n, 0}, {n, n + 1, n});
    lattice.add(part, {-1, -1, n}, {n + 1, static_cast<int>(rng.below(2)), n + 1});
    return lattice;
  }

  void add(PartId part, const Corner& lo, const Corner& hi) {
    boxes[part].push_back({Eigen::Vector3d(lo[0], lo[1], lo[2]), Eigen::Vector3d(hi[0], hi[1], hi[2])});
    for (int x = lo[0]; x < hi[0]; ++x)
      for (int y = lo[1]; y < hi[1]; ++y)
        for (int z = lo[2]; z < hi[2]; ++z) cells[{x, y, z}] = part;
  }

  /// Parts have a gap between them.
  Assembly assembly() const {
    std::vector<std::pair<std::string, std::vector<Box>>> all;
    for (const std::vector<Box>& part : boxes) {
      all.push_back({"p" + std::to_string(all.size()), part});
      for (Box& box : all.back().second) {
        box.lo += Eigen::Vector3d::Constant(0.05);
        box.hi -= Eigen::Vector3d::Constant(0.05);
      }
    }
    return assembly_of(all);
  }

  /// Is a cell of `other` somewhere behind one of `part`, along the axis?
  bool blocks(PartId part, PartId other, int axis, int sign) const {
    for (const auto& [at, id] : cells) {
      if (id != part) continue;
      Corner next = at;
      for (int k = 0; k < kSize + 2; ++k) {
        next[axis] += sign;
        if (const auto cell = cells.find(next); cell != cells.end() && cell->second == other) return true;
      }
    }
    return false;
  }

  /// The fewest steps until the part is by itself, and of orders with so many steps the fewest changes of direction:
  /// breadth first over all sets of parts. None: it never is.
  std::optional<std::pair<unsigned, unsigned>> fewest_steps(PartId target) const {
    std::vector<std::array<unsigned, 6>> in_the_way(parts, std::array<unsigned, 6>{});  // sets of parts
    for (PartId id = 0; id < parts; ++id)
      for (int d = 0; d < 6; ++d)
        for (PartId other = 0; other < parts; ++other)
          if (other != id && blocks(id, other, d / 2, d % 2 == 0 ? 1 : -1)) in_the_way[id][d] |= 1U << other;
    std::map<std::pair<unsigned, int>, unsigned> layer{
        {{(1U << parts) - 1, -1}, 0}};  // present, last direction: changes
    for (unsigned steps = 0; !layer.empty(); ++steps) {
      std::map<std::pair<unsigned, int>, unsigned> next;
      std::optional<unsigned> changes;
      for (const auto& [state, so_far] : layer) {
        const auto [present, last] = state;
        if ((present >> target & 1U) == 0 || std::popcount(present) == 1)
          changes = std::min(changes.value_or(so_far), so_far);
        for (PartId id = 0; id < parts; ++id)
          for (int d = 0; (present >> id & 1U) != 0 && d < 6; ++d) {
            if (contains(constraints.base, id) || (present & in_the_way[id][d]) != 0) continue;
            const unsigned now = so_far + (last >= 0 && last != d ? 1 : 0);
            const auto [entry, is_new] = next.try_emplace({present & ~(1U << id), d}, now);
            entry->second = std::min(entry->second, now);
          }
      }
      if (changes) return std::pair(steps, *changes);
      layer = std::move(next);
    }
    return std::nullopt;
  }
};

}  // namespace dismantle::fake
