#include "dismantle/geometry/row_runs.h"

#include <bit>

namespace dismantle::geometry {

void RowRuns::add(std::size_t row, std::int32_t first, std::int32_t last, const Bits& bits) {
  add_to(in_row_[row], bits);
  std::vector<Added>& list = added_[row];
  if (!list.empty()) {  // neighbouring triangles often continue each other
    Added& before = list.back();
    if (before.bits[0] == bits[0] && before.bits[1] == bits[1] && first <= before.last + 1 &&
        last >= before.first - 1) {
      before.first = std::min(before.first, first);
      before.last = std::max(before.last, last);
      return;
    }
  }
  list.push_back({first, last, bits});
}

void RowRuns::finish() {
  begin_.assign(1, 0);
  for (std::vector<Added>& list : added_) {
    finish_row(list);
    std::vector<Added>().swap(list);
    begin_.push_back(runs_.size());
  }
}

/// Goes through the ends of the runs from left to right and counts by element how many of them are open.
void RowRuns::finish_row(const std::vector<Added>& added) {
  struct End {
    std::int32_t cell;
    std::uint32_t index;
    bool opens;
  };
  std::vector<End> ends;
  ends.reserve(2 * added.size());
  for (std::uint32_t k = 0; k < added.size(); ++k) {
    ends.push_back({added[k].first, k, true});
    ends.push_back({added[k].last + 1, k, false});
  }
  std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) { return a.cell < b.cell; });
  std::array<std::uint32_t, 128> open{};
  Bits bits{};
  for (std::size_t k = 0; k < ends.size();) {
    const std::int32_t cell = ends[k].cell;
    const Bits before = bits;
    for (; k < ends.size() && ends[k].cell == cell; ++k)
      for (std::size_t word = 0; word < 2; ++word)
        for (std::uint64_t rest = added[ends[k].index].bits[word]; rest != 0; rest &= rest - 1) {
          const auto bit = static_cast<std::size_t>(std::countr_zero(rest));
          std::uint32_t& count = open[64 * word + bit];
          count += ends[k].opens ? 1 : -1;
          if (count == 0)
            bits[word] &= ~(1ULL << bit);
          else
            bits[word] |= 1ULL << bit;
        }
    if (bits != before) runs_.push_back({cell, bits});
  }
}

}  // namespace dismantle::geometry
