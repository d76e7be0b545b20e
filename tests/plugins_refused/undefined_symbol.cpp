// Needs a function that no library has.
#include "dismantle/plugin.h"

namespace acme {
std::string missing_function(int);
}

DISMANTLE_PLUGIN("acme.undefined", "1.0.0", "MIT", "https://example.org") {
  if (!acme::missing_function(static_cast<int>(r.types().size())).empty()) return;
}
