#include "dismantle/outcome.h"

#include <array>
#include <utility>

namespace dismantle {

namespace {

constexpr std::array<std::pair<Outcome, std::string_view>, 9> kNames{{
    {Outcome::solved, "solved"},
    {Outcome::start_is_goal, "start_is_goal"},
    {Outcome::timeout, "timeout"},
    {Outcome::depth_limit, "depth_limit"},
    {Outcome::exhausted, "exhausted"},
    {Outcome::invalid_start, "invalid_start"},
    {Outcome::cancelled, "cancelled"},
    {Outcome::unsupported, "unsupported"},
    {Outcome::crashed, "crashed"},
}};

}  // namespace

std::string_view to_string(Outcome o) {
  for (const auto& [value, name] : kNames)
    if (value == o) return name;
  return "unknown";
}

std::optional<Outcome> outcome_from_string(std::string_view text) {
  for (const auto& [value, name] : kNames)
    if (name == text) return value;
  return std::nullopt;
}

}  // namespace dismantle
