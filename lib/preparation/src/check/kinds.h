// The kinds of the parts of an assembly, for dismantle check.
#pragma once

#include <string>
#include <vector>

#include "dismantle/preparation/check_assembly.h"

namespace dismantle {

std::vector<CheckedKind> checked_kinds(const Assembly& assembly);

/// A table, equal parts in one line; empty if nothing but `other` was found. `verbose`: with all reasons.
std::string kinds_text(const std::vector<CheckedKind>& kinds, bool verbose);

}  // namespace dismantle
