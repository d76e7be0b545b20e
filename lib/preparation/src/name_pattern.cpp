#include "dismantle/preparation/name_pattern.h"

#include <fnmatch.h>

namespace dismantle {

bool name_matches(const std::string& name, const std::string& pattern) {
  return name == pattern || ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

}  // namespace dismantle
