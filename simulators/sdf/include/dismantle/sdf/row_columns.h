/// Gaps of many contact rows at a time.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "dismantle/sdf/contact_row.h"

namespace dismantle::sdf {

/// Keeps the rows of one body column by column: most of them do not hold, so that a solver reads their gaps and nothing
/// else of them. Gaps are the same to the last bit as ContactRow::gap_at(). Grows, and allocates nothing once warm.
class RowColumns {
 public:
  /// Gaps are those at x = 0 then. `Dof`: 3 or 6, one body; Eigen::Dynamic: several.
  template <int Dof>
  void assign(const std::vector<ContactRow>& rows) {
    rows_ = rows.data();
    count_ = rows.size();
    gaps_.resize(count_);
    next_.resize(count_);
    alternatives_.resize(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      gaps_[i] = rows[i].gap;
      alternatives_[i] = rows[i].alternatives;
    }
    if constexpr (Dof != Eigen::Dynamic) {
      entries_.resize(count_ * (Dof + 1));
      for (std::size_t i = 0; i < count_; ++i) {
        const auto& j = rows[i].first >= 0 ? rows[i].j_first : rows[i].j_second;
        entries_[i] = rows[i].gap;
        for (int k = 0; k < Dof; ++k) entries_[(static_cast<std::size_t>(k) + 1) * count_ + i] = j[k];
      }
    }
  }

  /// Gaps at x, kept beside those of the last keep().
  template <int Dof, class Vector>
  void try_at(const Vector& x, int per_body) {
    if constexpr (Dof == Eigen::Dynamic) {
      for (std::size_t i = 0; i < count_; ++i) next_[i] = rows_[i].gap_at(x, per_body);
    } else {
      const auto n = static_cast<Eigen::Index>(count_);
      const auto column = [&](int k) { return Eigen::ArrayXd::Map(entries_.data() + k * n, n); };
      auto next = Eigen::ArrayXd::Map(next_.data(), n);
      if constexpr (Dof == 3)
        next = column(0) + column(1) * x[0] + column(2) * x[1] + column(3) * x[2];
      else
        next = column(0) + column(1) * x[0] + column(2) * x[1] + column(3) * x[2] + column(4) * x[3] +
               column(5) * x[4] + column(6) * x[5];
    }
  }
  void keep() { std::swap(gaps_, next_); }

  /// What holds: `use(row, gap)` for each contact whose gap is below zero, and of its alternatives the largest.
  /// `tried`: at the point of the last try_at(), else at that of the last keep().
  template <class Use>
  void for_each_held(bool tried, const Use& use) const {
    const std::vector<double>& gaps = tried ? next_ : gaps_;
    for (std::size_t i = 0; i < count_; i += 1 + static_cast<std::size_t>(alternatives_[i])) {
      double g = gaps[i];
      if (g >= 0) continue;
      std::size_t best = i;
      for (std::size_t k = i + 1; g < 0 && k <= i + static_cast<std::size_t>(alternatives_[i]); ++k)
        if (gaps[k] > g) g = gaps[k], best = k;
      if (g < 0) use(rows_[best], g);
    }
  }

 private:
  const ContactRow* rows_ = nullptr;
  std::size_t count_ = 0;
  std::vector<double> entries_, gaps_, next_;
  std::vector<std::int32_t> alternatives_;
};

}  // namespace dismantle::sdf
