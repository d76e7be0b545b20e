/// Spelling suggestions: "did you mean ...?"
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dismantle/export.h"

namespace dismantle {

/// Least number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`
/// (optimal string alignment; bytes).
DISMANTLE_API std::size_t edit_distance(const std::string& a, const std::string& b);

/// The candidate closest to `word`, if it is at most max(1, length of word / 3) edits away; ties go to the first.
DISMANTLE_API std::optional<std::string> nearest(const std::string& word, const std::vector<std::string>& candidates);

/// What to write instead of a built-in type or key that is no more; empty: it is none.
DISMANTLE_API std::string advice_for_removed(const std::string& name);

}  // namespace dismantle
