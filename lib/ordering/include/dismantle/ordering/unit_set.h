/// Sets of units, the things that an order is made of.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dismantle::order {

/// A set of small numbers. All sets of one problem have the same capacity.
class UnitSet {
 public:
  UnitSet() = default;
  explicit UnitSet(std::size_t capacity, bool full = false) : words_((capacity + 63) / 64, 0) {
    if (full)
      for (std::size_t u = 0; u < capacity; ++u) insert(u);
  }
  void insert(std::size_t u) { words_[u / 64] |= bit(u); }
  void erase(std::size_t u) { words_[u / 64] &= ~bit(u); }
  bool contains(std::size_t u) const { return (words_[u / 64] & bit(u)) != 0; }
  std::size_t size() const {
    std::size_t n = 0;
    for (const std::uint64_t w : words_) n += static_cast<std::size_t>(std::popcount(w));
    return n;
  }
  bool empty() const {
    return std::all_of(words_.begin(), words_.end(), [](std::uint64_t w) { return w == 0; });
  }
  bool intersects(const UnitSet& other) const {
    for (std::size_t k = 0; k < words_.size(); ++k)
      if ((words_[k] & other.words_[k]) != 0) return true;
    return false;
  }
  bool includes(const UnitSet& other) const {
    for (std::size_t k = 0; k < words_.size(); ++k)
      if ((other.words_[k] & ~words_[k]) != 0) return false;
    return true;
  }
  UnitSet& operator|=(const UnitSet& other) {
    for (std::size_t k = 0; k < words_.size(); ++k) words_[k] |= other.words_[k];
    return *this;
  }
  UnitSet& operator&=(const UnitSet& other) {
    for (std::size_t k = 0; k < words_.size(); ++k) words_[k] &= other.words_[k];
    return *this;
  }
  UnitSet& operator-=(const UnitSet& other) {
    for (std::size_t k = 0; k < words_.size(); ++k) words_[k] &= ~other.words_[k];
    return *this;
  }
  UnitSet operator-(const UnitSet& other) const {
    UnitSet result = *this;
    for (std::size_t k = 0; k < words_.size(); ++k) result.words_[k] &= ~other.words_[k];
    return result;
  }
  bool operator==(const UnitSet&) const = default;
  /// Calls `visit` with each member, ascending.
  template <class Visit>
  void each(Visit visit) const {
    for (std::size_t k = 0; k < words_.size(); ++k)
      for (std::uint64_t w = words_[k]; w != 0; w &= w - 1)
        visit(64 * k + static_cast<std::size_t>(std::countr_zero(w)));
  }
  /// True if `test` holds for each member of `set` that is in neither `but` nor `nor`. Asks in ascending order, up to
  /// the first for which it does not.
  template <class Test>
  static bool all_of_rest(const UnitSet& set, const UnitSet& but, const UnitSet& nor, Test test) {
    for (std::size_t k = 0; k < set.words_.size(); ++k)
      for (std::uint64_t w = set.words_[k] & ~but.words_[k] & ~nor.words_[k]; w != 0; w &= w - 1)
        if (!test(64 * k + static_cast<std::size_t>(std::countr_zero(w)))) return false;
    return true;
  }
  std::size_t hash() const {
    std::uint64_t h = 0x9e3779b97f4a7c15ULL;
    for (const std::uint64_t w : words_) h = (h ^ w) * 0xbf58476d1ce4e5b9ULL, h ^= h >> 31;
    return static_cast<std::size_t>(h);
  }

 private:
  static std::uint64_t bit(std::size_t u) { return std::uint64_t{1} << (u % 64); }
  std::vector<std::uint64_t> words_;
};

struct UnitSetHash {
  std::size_t operator()(const UnitSet& units) const { return units.hash(); }
};

}  // namespace dismantle::order
