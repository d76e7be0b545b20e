/// Search over the arrangements of parts that lie on a grid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "dismantle/lattice/lattice.h"

namespace dismantle::lattice {

using PartBits = std::uint64_t;  ///< a set of parts, by their index
inline constexpr std::size_t kMostParts = std::numeric_limits<PartBits>::digits;

/// The cells of one part, ascending.
struct PieceCells {
  std::vector<Cell> full;     ///< two parts never are in the same one
  std::vector<Cell> touched;  ///< these, and others that the part reaches into: curved outsides, chamfers
};

/// May part `moving`, shifted by `shift` cells relative to part `fixed`, move one cell on along the axis?
using StepTest = std::function<bool(std::size_t moving, std::size_t fixed, const Cell& shift, int axis)>;

/// One straight slide of a rigid group of parts.
struct Slide {
  PartBits parts = 0;
  int axis = 0;    ///< of the lattice
  int steps = 0;   ///< in cells, with sign; 0 with `leaves`
  int leaves = 0;  ///< 1 or -1: along or against the axis for ever; 0: they stop after `steps`
};

struct SearchLimits {
  std::size_t arrangements = 60'000;
  double work = 1e9;  ///< arrangements that are made and looked up, and steps of pairs
  std::function<bool()> stop;
};

struct SearchResult {
  enum class End { found, exhausted, limit, stopped, unsuited };
  End end = End::unsuited;
  std::vector<Slide> slides;  ///< found: the fewest slides until parts leave; the last one leaves
  std::size_t visited = 0;    ///< arrangements
  std::size_t waiting = 0;    ///< arrangements that were found and not visited
  /// Exhausted: all arrangements that can be reached; of each, the steps of the second and later parts relative to the
  /// first one, from where they began.
  std::vector<std::vector<Cell>> arrangements;
};

/// An arrangement is one shift of each part by whole cells. From each, every rigid group may slide along every axis as
/// many cells as it can, whatever it passes. Breadth first: the number of slides is the least. The search is complete
/// for translations by whole cells, also of several parts at once, which are slides one after the other.
/// With more than 8 loose parts not all unions of groups are tried as one slide (256 at a time); then the number of
/// slides may not be the least, but all arrangements are still found.
/// `unsuited`: more than kMostParts parts, or two parts have a cell in common.
SearchResult search_arrangements(const std::vector<std::vector<Cell>>& parts, const SearchLimits& limits,
                                 bool list_arrangements = false);

/// The same for parts that fill some cells in part. `passes` decides about steps where two parts share cells, but no
/// full ones; it is asked once for each pair, shift and axis.
SearchResult search_arrangements(const std::vector<PieceCells>& parts, const StepTest& passes,
                                 const SearchLimits& limits, bool list_arrangements = false);

}  // namespace dismantle::lattice
