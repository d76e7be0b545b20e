/// Evaluates the gaps of many contact rows at once.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "dismantle/sdf/contact_row.h"

namespace dismantle::sdf {

/// Stores the rows of one body by column: most contacts are inactive, so a solver reads only their gaps. Gaps are
/// bitwise equal to ContactRow::gap_at(). Does not allocate once its buffers have grown.
class RowColumns {
 public:
  /// Sets the gaps to those at x = 0. `Dof`: 3 or 6 for one body; Eigen::Dynamic for several.
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

  /// Evaluates the gaps at x; those of the last keep() stay available.
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

  /// Calls `use(row, gap)` for each active contact: the row with the largest gap of its alternatives, if that is
  /// negative. `tried`: at the point of the last try_at(), else at that of the last keep().
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
