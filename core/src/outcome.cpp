#include "dismantle/outcome.h"

#include <array>

namespace dismantle {

namespace {

/// By Outcome.
constexpr std::array<std::string_view, 10> kNames{"solved",     "start_is_goal", "timeout",   "depth_limit", "exhausted",
                                                  "infeasible", "invalid_start", "cancelled", "unsupported", "crashed"};
static_assert(static_cast<std::size_t>(Outcome::crashed) + 1 == kNames.size());

}  // namespace

std::string_view to_string(Outcome o) {
  const auto i = static_cast<std::size_t>(o);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::optional<Outcome> outcome_from_string(std::string_view text) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == text) return static_cast<Outcome>(i);
  return std::nullopt;
}

}  // namespace dismantle
