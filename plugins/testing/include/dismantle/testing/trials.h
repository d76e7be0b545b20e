/// How many random trials a test makes.
#pragma once

#include <cstdlib>
#include <string_view>

namespace dismantle::testing_support {

/// Is this the long form of the tests (DISMANTLE_TESTS=nightly)?
inline bool nightly() {
  const char* mode = std::getenv("DISMANTLE_TESTS");
  return mode != nullptr && std::string_view(mode) == "nightly";
}

/// The same law on more cases at night.
inline int trials(int daily, int at_night) { return nightly() ? at_night : daily; }

}  // namespace dismantle::testing_support
