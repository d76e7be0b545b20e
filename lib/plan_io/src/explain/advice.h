/// What a user can do about parts that did not come out.
#pragma once

#include <string>
#include <vector>

#include "dismantle/plan_io/explain.h"

namespace dismantle {

/// The outcome of a search in words.
const char* meaning_of(Outcome outcome);
/// Sentences that name the key to set and, where it is known, the value that it had.
std::vector<std::string> advice_on(const LeftReason& reason, const Plan& plan, const ExplainSettings& settings);

}  // namespace dismantle
