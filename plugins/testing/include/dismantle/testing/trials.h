/// Numbers of random trials in tests.
#pragma once

#include <cstdlib>
#include <string_view>

namespace dismantle::testing_support {

/// True in the long form of the tests (DISMANTLE_TESTS=nightly).
inline bool nightly() {
  const char* mode = std::getenv("DISMANTLE_TESTS");
  return mode != nullptr && std::string_view(mode) == "nightly";
}

/// Number of random cases: more in the nightly tests.
inline int trials(int daily, int at_night) { return nightly() ? at_night : daily; }

}  // namespace dismantle::testing_support
