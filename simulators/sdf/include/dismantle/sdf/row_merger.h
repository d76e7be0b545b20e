/// Merges equal contacts: flush parts touch at hundreds of points with the same row.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "dismantle/geometry/numerics.h"
#include "dismantle/sdf/contact_row.h"

namespace dismantle::sdf {

/// For bodies that only translate: contacts with the same normals and gaps, to within rounding, have the same rows. One
/// row with the sum of their stiffness replaces them.
class RowMerger {
 public:
  /// Call after each contact: [first, rows.size()) are its rows. Removes them if they equal earlier ones.
  void add(std::vector<ContactRow>& rows, std::size_t first) {
    const std::uint64_t h = hash(rows, first);
    for (std::size_t slot = h & mask();; slot = (slot + 1) & mask()) {
      Entry& e = table_[slot];
      if (e.round != round_) {
        e = {h, static_cast<std::uint32_t>(first), round_};
        if (2 * ++used_ > table_.size()) grow();
        return;
      }
      if (e.hash != h || !alike(rows, e.first, first)) continue;
      for (std::size_t k = 0; first + k < rows.size(); ++k) rows[e.first + k].stiffness += rows[first + k].stiffness;
      rows.resize(first);
      return;
    }
  }
  void clear() {
    ++round_;
    used_ = 0;
  }

 private:
  struct Entry {
    std::uint64_t hash = 0;
    std::uint32_t first = 0, round = 0;
  };
  std::size_t mask() const { return table_.size() - 1; }

  static std::int64_t rounded(double x) { return static_cast<std::int64_t>(std::floor(x / geometry::kRounding + 0.5)); }
  static std::uint64_t mix(std::uint64_t h, std::int64_t x) {
    h ^= static_cast<std::uint64_t>(x) + 0x9e3779b97f4a7c15U + (h << 6) + (h >> 2);
    return h * 0xff51afd7ed558ccdU;
  }
  static std::uint64_t hash(const std::vector<ContactRow>& rows, std::size_t first) {
    std::uint64_t h = static_cast<std::uint64_t>(rows[first].first * 64 + rows[first].second);
    for (std::size_t i = first; i < rows.size(); ++i) {
      h = mix(h, rounded(rows[i].gap));
      for (int k = 0; k < 3; ++k) {
        if (rows[i].first >= 0) h = mix(h, rounded(rows[i].j_first[k]));
        if (rows[i].second >= 0) h = mix(h, rounded(rows[i].j_second[k]));
      }
    }
    return h ^ (h >> 29);
  }
  static bool alike(const std::vector<ContactRow>& rows, std::size_t a, std::size_t b) {
    const std::size_t count = rows.size() - b;
    if (static_cast<std::size_t>(rows[a].alternatives) + 1 != count) return false;
    for (std::size_t i = 0; i < count; ++i) {
      const ContactRow &x = rows[a + i], &y = rows[b + i];
      if (x.first != y.first || x.second != y.second || rounded(x.gap) != rounded(y.gap)) return false;
      for (int k = 0; k < 3; ++k) {
        if (x.first >= 0 && rounded(x.j_first[k]) != rounded(y.j_first[k])) return false;
        if (x.second >= 0 && rounded(x.j_second[k]) != rounded(y.j_second[k])) return false;
      }
    }
    return true;
  }
  void grow() {
    const std::vector<Entry> old = std::move(table_);
    table_.assign(old.size() * 2, {});
    for (const Entry& e : old) {
      if (e.round != round_) continue;
      std::size_t slot = e.hash & mask();
      while (table_[slot].round == round_) slot = (slot + 1) & mask();
      table_[slot] = e;
    }
  }

  std::vector<Entry> table_ = std::vector<Entry>(1024);
  std::size_t used_ = 0;
  std::uint32_t round_ = 1;
};

}  // namespace dismantle::sdf
