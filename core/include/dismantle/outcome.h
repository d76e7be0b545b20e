/// How an attempt ended.
#pragma once

#include <optional>
#include <string_view>

#include "dismantle/export.h"

namespace dismantle {

/// How an attempt, a search or a run ended.
enum class Outcome {
  solved,
  start_is_goal,  ///< nothing to do: the part is already separated
  timeout,        ///< seconds or step budget used up
  depth_limit,    ///< searched to the allowed depth; a deeper search might succeed
  exhausted,      ///< no state left to search at this resolution; another search may still succeed
  infeasible,     ///< proved: no motion separates the parts
  invalid_start,  ///< the start state is not valid
  cancelled,      ///< the user asked to stop
  unsupported,    ///< the simulator lacks a capability that the planner needs
  crashed,        ///< the plugin threw; set by the oracle only
};

/// True for `solved` and `start_is_goal`.
constexpr bool is_success(Outcome o) { return o == Outcome::solved || o == Outcome::start_is_goal; }
/// Name in files and messages.
DISMANTLE_API std::string_view to_string(Outcome o);
/// Inverse of to_string(); empty for other texts.
DISMANTLE_API std::optional<Outcome> outcome_from_string(std::string_view text);

}  // namespace dismantle
