/// Sets for the cells of a raster, stored as runs of cells.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dismantle::geometry {

/// A set of up to 128 elements for each cell of a raster. The sets of neighbouring cells in a row are mostly equal:
/// work and memory are in proportion to the runs that are added, not to the cells that these cover.
class RowRuns {
 public:
  using Bits = std::array<std::uint64_t, 2>;  ///< a set; element k is bit k % 64 of word k / 64
  /// True if no element is in both.
  static bool disjoint(const Bits& x, const Bits& y) { return ((x[0] & y[0]) | (x[1] & y[1])) == 0; }
  static void add_to(Bits& x, const Bits& y) {
    x[0] |= y[0];
    x[1] |= y[1];
  }

  RowRuns() = default;
  explicit RowRuns(std::size_t rows) : added_(rows), in_row_(rows) {}

  /// Adds `bits` to the cells `first` to `last` of a row.
  void add(std::size_t row, std::int32_t first, std::int32_t last, const Bits& bits);
  /// To be called once, after the last add().
  void finish();

  /// Union of the sets of a row.
  const Bits& in_row(std::size_t row) const { return in_row_[row]; }

  /// Calls f(bits) for the runs of different sets that overlap the cells `first` to `last`, in order. False as soon as
  /// f returns false.
  template <class F>
  bool each(std::size_t row, std::int32_t first, std::int32_t last, const F& f) const {
    const auto begin = runs_.begin() + static_cast<std::ptrdiff_t>(begin_[row]);
    const auto end = runs_.begin() + static_cast<std::ptrdiff_t>(begin_[row + 1]);
    auto run = std::upper_bound(begin, end, first, [](std::int32_t cell, const Run& r) { return cell < r.first; });
    if (run != begin) --run;  // it begins at or before `first`
    for (; run != end && run->first <= last; ++run)
      if (!f(run->bits)) return false;
    return true;
  }

 private:
  struct Added {
    std::int32_t first, last;
    Bits bits;
  };
  struct Run {
    std::int32_t first;  // up to the next run
    Bits bits;
  };
  void finish_row(const std::vector<Added>& added);

  std::vector<std::vector<Added>> added_;  // by row; empty when finished
  std::vector<Run> runs_;                  // row by row, ascending
  std::vector<std::size_t> begin_;         // by row, and the end
  std::vector<Bits> in_row_;
};

}  // namespace dismantle::geometry
