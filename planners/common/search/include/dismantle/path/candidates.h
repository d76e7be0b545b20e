/// Showing forms of one path to the checker until it accepts one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "dismantle/path_planner.h"

namespace dismantle::path {

/// What happened to a candidate.
struct Shown {
  bool accepted = false;
  PathCheck last{};  ///< the last refusal, and ...
  Path path{};       ///< ... the form that it is about
};

/// `form(k)`: the k-th form of the path, nothing when there are no more.
/// `learn(check, path)`: takes note of a refusal; is the next form to be shown?
/// `accept(verified)` takes over what was accepted; refusals are counted.
template <class Form, class Learn, class Accept>
Shown show_forms(const PathChecker& checker, std::uint64_t& refused, const Form& form, const Learn& learn,
                 const Accept& accept) {
  Shown shown;
  for (std::size_t k = 0;; ++k) {
    std::optional<Path> path = form(k);
    if (!path) return shown;
    shown.path = std::move(*path);
    shown.last = checker.check(shown.path);
    if (shown.last.accepted()) {
      shown.accepted = true;
      accept(std::move(*shown.last.verified));
      return shown;
    }
    ++refused;
    if (!learn(shown.last, shown.path)) return shown;
  }
}

}  // namespace dismantle::path
