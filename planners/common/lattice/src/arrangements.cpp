#include "dismantle/lattice/arrangements.h"

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <unordered_set>
#include <utility>

namespace dismantle::lattice {
namespace {

constexpr int kForEver = std::numeric_limits<int>::max();
constexpr std::size_t kMostUnions = 256;
constexpr double kWorkOfQuestion = 1'000;  // a question about two surfaces takes as long as this many queries of cells

/// The shifts of one part relative to another at which they share full cells, or cells that both reach into.
class Overlaps {
 public:
  Overlaps(const PieceCells& a, const PieceCells& b) {
    const std::vector<Cell>&moving = a.touched, &fixed = b.touched;
    Cell hi{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto by = [k](const Cell& p, const Cell& q) { return p[k] < q[k]; };
      const auto [m0, m1] = std::minmax_element(moving.begin(), moving.end(), by);
      const auto [f0, f1] = std::minmax_element(fixed.begin(), fixed.end(), by);
      lo_[k] = (*f0)[k] - (*m1)[k];
      hi[k] = (*f1)[k] - (*m0)[k];
      size_[k] = hi[k] - lo_[k] + 1;
    }
    const std::size_t count =
        static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(size_[2]);
    const auto mark = [&](std::vector<bool>& bits, const std::vector<Cell>& of, const std::vector<Cell>& other) {
      bits.assign(count, false);
      for (const Cell& m : of)
        for (const Cell& f : other) bits[index({f[0] - m[0], f[1] - m[1], f[2] - m[2]})] = true;
    };
    mark(bits_, a.full, b.full);
    if (a.full != a.touched || b.full != b.touched) mark(near_, a.touched, b.touched);
  }

  bool at(const Cell& shift) const { return within(shift) && bits_[index(shift)]; }
  bool near(const Cell& shift) const { return !near_.empty() && within(shift) && near_[index(shift)]; }

  /// The number of steps along an axis that are free from here; kForEver if all are. `passes(shift)` is asked about
  /// steps between shifts where only cells that are not full are shared.
  template <class Passes>
  int free_steps(Cell shift, std::size_t axis, double& work, const Passes& passes) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (k != axis && (shift[k] < lo_[k] || shift[k] >= lo_[k] + size_[k])) return kForEver;
    const int from = shift[axis];
    for (shift[axis] = std::max(from + 1, lo_[axis]); shift[axis] < lo_[axis] + size_[axis]; ++shift[axis]) {
      ++work;
      if (bits_[index(shift)]) return shift[axis] - from - 1;
      if (near_.empty()) continue;
      Cell before = shift;
      --before[axis];
      if ((near(before) || near(shift)) && !passes(before)) return before[axis] - from;
    }
    // The last step away.
    if (Cell before = shift; --before[axis] >= from && near(before) && !passes(before)) return before[axis] - from;
    return kForEver;
  }

 private:
  bool within(const Cell& shift) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (shift[k] < lo_[k] || shift[k] >= lo_[k] + size_[k]) return false;
    return true;
  }
  std::size_t index(const Cell& s) const {
    return (static_cast<std::size_t>(s[0] - lo_[0]) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(s[1] - lo_[1])) *
               static_cast<std::size_t>(size_[2]) +
           static_cast<std::size_t>(s[2] - lo_[2]);
  }

  Cell lo_{}, size_{};
  std::vector<bool> bits_;
  std::vector<bool> near_;  // empty: as bits_
};

class Search {
 public:
  Search(const std::vector<PieceCells>& parts, const StepTest& passes, const SearchLimits& limits)
      : limits_(limits), passes_(passes), count_(parts.size()), everyone_(~PartBits{0} >> (kMostParts - count_)) {
    for (const auto& a : parts)
      for (const auto& b : parts) overlaps_.emplace_back(a, b);
    free_.resize(count_ * count_);
  }

  bool begins_apart() const {
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (overlaps_[i * count_ + j].at({0, 0, 0})) return false;
    return true;
  }

  SearchResult run(bool list_arrangements) {
    using End = SearchResult::End;
    const std::vector<Cell> start(count_, Cell{});
    add(start, 0, {});
    SearchResult result;
    for (std::size_t node = 0; node < steps_.size(); ++node) {
      result.waiting = steps_.size() - node;
      const bool stop = (node & 63) == 0 && limits_.stop && limits_.stop();
      if (stop || node >= limits_.arrangements || work_ > limits_.work) {
        result.end = stop ? End::stopped : End::limit;
        return result;
      }
      result.visited = node + 1;
      if (const auto leaving = expand(node)) {
        result.end = End::found;
        result.slides = slides_to(node, *leaving);
        return result;
      }
    }
    result.end = End::exhausted;
    result.waiting = 0;
    if (list_arrangements)
      for (std::size_t node = 0; node < steps_.size(); ++node) {
        std::vector<Cell> at = shifts(node);
        at.erase(at.begin());
        result.arrangements.push_back(std::move(at));
      }
    return result;
  }

 private:
  struct Step {
    std::uint32_t parent = 0;
    Slide slide;
  };

  std::vector<Cell> shifts(std::size_t node) const {
    std::vector<Cell> at(count_);
    for (std::size_t i = 1; i < count_; ++i)
      for (std::size_t k = 0; k < 3; ++k) at[i][k] = places_[3 * ((count_ - 1) * node + i - 1) + k];
    return at;
  }

  void add(const std::vector<Cell>& at, std::size_t parent, const Slide& slide) {
    ++work_;
    const auto node = static_cast<std::uint32_t>(steps_.size());
    for (std::size_t i = 1; i < count_; ++i)
      for (std::size_t k = 0; k < 3; ++k) places_.push_back(static_cast<std::int16_t>(at[i][k] - at[0][k]));
    if (seen_.insert(node).second)
      steps_.push_back({static_cast<std::uint32_t>(parent), slide});
    else
      places_.resize(places_.size() - 3 * (count_ - 1));
  }

  void measure(const std::vector<Cell>& at, std::size_t axis) {
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t j = 0; j < count_; ++j)
        free_[i * count_ + j] = i == j ? kForEver
                                       : overlaps_[i * count_ + j].free_steps(
                                             {at[i][0] - at[j][0], at[i][1] - at[j][1], at[i][2] - at[j][2]}, axis,
                                             work_, [&](const Cell& from) { return passes(i, j, from, axis); });
  }

  /// One step of part i along the axis, past part j; a step of j back is the same.
  bool passes(std::size_t i, std::size_t j, Cell shift, std::size_t axis) {
    if (i > j) {
      std::swap(i, j);
      for (int& s : shift) s = -s;
      --shift[axis];
    }
    const auto [known, is_new] = asked_.try_emplace({i * count_ + j, shift, axis}, false);
    if (!is_new) return known->second;
    work_ += kWorkOfQuestion;
    return known->second = passes_(i, j, shift, static_cast<int>(axis));
  }

  /// All parts that move when a part moves by `steps`, since it runs into them; backwards: along the other way.
  PartBits taken_along(std::size_t part, int steps, bool backwards) const {
    PartBits set = PartBits{1} << part, open = set;
    while (open != 0) {
      const auto g = static_cast<std::size_t>(std::countr_zero(open));
      open &= open - 1;
      for (std::size_t j = 0; j < count_; ++j) {
        if ((set >> j & 1) != 0 || (backwards ? free_[j * count_ + g] : free_[g * count_ + j]) >= steps) continue;
        set |= PartBits{1} << j;
        open |= PartBits{1} << j;
      }
    }
    return set;
  }

  std::optional<Slide> smallest_that_leaves(int axis) const {
    std::optional<Slide> best;
    for (const bool backwards : {false, true})
      for (std::size_t i = 0; i < count_; ++i) {
        const PartBits set = taken_along(i, kForEver, backwards);
        if (set != everyone_ && (!best || std::popcount(set) < std::popcount(best->parts)))
          best = Slide{set, axis, 0, backwards ? -1 : 1};
      }
    return best;
  }

  /// The rigid groups that can move by `steps`: those that single parts take along, and unions of these.
  std::vector<PartBits> groups(int steps) const {
    std::vector<PartBits> found;
    const auto add_new = [&](PartBits set) {
      if (set != everyone_ && std::find(found.begin(), found.end(), set) == found.end()) found.push_back(set);
    };
    for (std::size_t i = 0; i < count_; ++i) add_new(taken_along(i, steps, false));
    const std::size_t least = found.size();
    for (std::size_t a = 0; a < found.size() && found.size() < kMostUnions; ++a)
      for (std::size_t b = 0; b < least && found.size() < kMostUnions; ++b) add_new(found[a] | found[b]);
    return found;
  }

  /// Adds the arrangements one slide from this one. Ends early if parts can leave.
  std::optional<Slide> expand(std::size_t node) {
    const std::vector<Cell> at = shifts(node);
    std::optional<Slide> leaving;
    for (int axis = 0; axis < 3; ++axis) {
      measure(at, static_cast<std::size_t>(axis));
      if (const auto slide = smallest_that_leaves(axis);
          slide && (!leaving || std::popcount(slide->parts) < std::popcount(leaving->parts)))
        leaving = slide;
      if (leaving) continue;
      // A group that moves the other way is the same as the rest moving this way.
      for (int steps = 1;; ++steps) {
        const std::vector<PartBits> sets = groups(steps);
        if (sets.empty()) break;
        for (const PartBits set : sets) {
          std::vector<Cell> next = at;
          for (std::size_t i = 0; i < count_; ++i)
            if (set >> i & 1) next[i][static_cast<std::size_t>(axis)] += steps;
          add(next, node, {set, axis, steps, 0});
        }
      }
    }
    return leaving;
  }

  std::vector<Slide> slides_to(std::size_t node, const Slide& last) const {
    std::vector<Slide> slides{last};
    for (; node != 0; node = steps_[node].parent) slides.push_back(steps_[node].slide);
    std::reverse(slides.begin(), slides.end());
    return slides;
  }

  const SearchLimits& limits_;
  const StepTest& passes_;
  std::map<std::tuple<std::size_t, Cell, std::size_t>, bool> asked_;  // by pair, shift and axis
  const std::size_t count_;
  const PartBits everyone_;
  std::vector<Overlaps> overlaps_;    // by ordered pair
  std::vector<int> free_;             // by ordered pair, along the axis measured last
  std::vector<Step> steps_;           // by arrangement: how it was reached
  std::vector<std::int16_t> places_;  // by arrangement: shifts of all parts but the first, relative to it
  double work_ = 0;

  std::size_t hash(std::uint32_t node) const {
    std::uint64_t h = 0x9e3779b97f4a7c15ULL;
    const std::size_t size = 3 * (count_ - 1);
    for (std::size_t k = size * node; k < size * (node + 1); ++k)
      h = (h ^ static_cast<std::uint16_t>(places_[k])) * 0xbf58476d1ce4e5b9ULL, h ^= h >> 29;
    return static_cast<std::size_t>(h);
  }
  bool same(std::uint32_t a, std::uint32_t b) const {
    const auto size = static_cast<std::ptrdiff_t>(3 * (count_ - 1));
    const auto begin = places_.begin() + size * static_cast<std::ptrdiff_t>(a);
    return std::equal(begin, begin + size, places_.begin() + size * static_cast<std::ptrdiff_t>(b));
  }
  struct Hash {
    const Search* search;
    std::size_t operator()(std::uint32_t node) const { return search->hash(node); }
  };
  struct Same {
    const Search* search;
    bool operator()(std::uint32_t a, std::uint32_t b) const { return search->same(a, b); }
  };
  std::unordered_set<std::uint32_t, Hash, Same> seen_{64, Hash{this}, Same{this}};
};

}  // namespace

SearchResult search_arrangements(const std::vector<PieceCells>& parts, const StepTest& passes,
                                 const SearchLimits& limits, bool list_arrangements) {
  if (parts.size() < 2 || parts.size() > kMostParts ||
      std::any_of(parts.begin(), parts.end(), [](const PieceCells& p) { return p.touched.empty(); }))
    return {};
  Search search(parts, passes, limits);
  if (!search.begins_apart()) return {};
  return search.run(list_arrangements);
}

SearchResult search_arrangements(const std::vector<std::vector<Cell>>& parts, const SearchLimits& limits,
                                 bool list_arrangements) {
  std::vector<PieceCells> pieces;
  for (const std::vector<Cell>& cells : parts) pieces.push_back({cells, cells});
  return search_arrangements(pieces, {}, limits, list_arrangements);
}

}  // namespace dismantle::lattice
