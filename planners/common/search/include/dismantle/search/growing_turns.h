/// Searches that take turns, each round twice as long as the last. The total
/// work is at most a constant factor of the work that the best search needs
/// alone (Luby, Sinclair and Zuckerman 1993).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace dismantle::path {

/// Total work allowed by a depth limit: `first` at depth 1, doubled with each
/// further level, unlimited at depth 0.
inline std::uint64_t doubled_per_level(double first, unsigned depth) {
  const std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();
  if (depth == 0) return unlimited;
  const double most = std::ldexp(first, static_cast<int>(std::min(depth, 64U)) - 1);
  return most < 1e18 ? static_cast<std::uint64_t>(most) : unlimited;
}

/// The amount of work at which a portion ends: `portion` more than `done` (0: no
/// limit), but at most `most`.
inline std::uint64_t end_of_portion(std::uint64_t done, std::uint64_t portion, std::uint64_t most) {
  return portion > 0 && done < most && portion < most - done ? done + portion : most;
}

class GrowingTurns {
 public:
  /// `first`: length of the turns in the first round, in units of work.
  GrowingTurns(std::size_t searches, std::uint64_t first) : searches_(searches), turn_(first) {}

  /// Continues where the last call stopped, until the total work of all
  /// searches is `limit`. `used()`: total work so far. `grow(i, until)`: search
  /// i works until `used()` is at least `until`; it returns true to end all
  /// searches. Returns true if grow() did.
  template <class Used, class Grow>
  bool run(std::uint64_t limit, const Used& used, const Grow& grow) {
    while (used() < limit) {
      if (end_ == 0) end_ = searches_ > 1 ? used() + turn_ : std::numeric_limits<std::uint64_t>::max();
      if (grow(current_, std::min(limit, end_))) return true;
      if (used() < end_) continue;
      end_ = 0;
      if (++current_ == searches_) current_ = 0, turn_ *= 2;
    }
    return false;
  }

 private:
  std::size_t searches_, current_ = 0;
  std::uint64_t turn_, end_ = 0;
};

}  // namespace dismantle::path
