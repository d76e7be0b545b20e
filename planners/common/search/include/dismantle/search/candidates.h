/// Shows forms of one path to the checker until it accepts one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "dismantle/path_planner.h"

namespace dismantle::path {

/// The checker's answers about the forms of one path.
struct Shown {
  bool accepted = false;
  PathCheck last{};  ///< of the last form shown
  Path path{};       ///< the last form shown
};

/// `form(k)`: returns the k-th form of the path; nothing if there are no more.
/// `learn(check, path)`: called for each refused form; returns true to show the next form.
/// `accept(verified)`: receives the accepted path. `refused`: incremented with each refusal.
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
