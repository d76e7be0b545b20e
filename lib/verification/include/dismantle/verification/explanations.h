/// Why parts cannot leave, in words: names, places in input units, lengths in assembly units.
#pragma once

#include <string>

#include "dismantle/export.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

DISMANTLE_API std::string describe(const Lock& lock, const Assembly& assembly);
DISMANTLE_API std::string describe(const Enclosure& enclosure, const Assembly& assembly);
DISMANTLE_API std::string describe(const Cage& cage, const Assembly& assembly);
DISMANTLE_API std::string describe(const Confinement& confinement, const Assembly& assembly);
DISMANTLE_API std::string describe(const Interlock& interlock, const Assembly& assembly);

}  // namespace dismantle
