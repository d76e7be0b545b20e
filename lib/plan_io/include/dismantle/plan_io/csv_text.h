/// Fields of CSV files (RFC 4180).
#pragma once

#include <string>

#include "dismantle/export.h"

namespace dismantle {

/// Valid UTF-8, quoted where RFC 4180 requires it.
DISMANTLE_API std::string csv_field(const std::string& raw);

}  // namespace dismantle
