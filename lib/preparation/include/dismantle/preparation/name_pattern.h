/// Patterns that stand for names of parts and products.
#pragma once

#include <string>

#include "dismantle/export.h"

namespace dismantle {

/// Is it the name itself, or one that the pattern of fnmatch(3) matches: * for any text, ? for a character, [a-z]?
DISMANTLE_API bool name_matches(const std::string& name, const std::string& pattern);

}  // namespace dismantle
