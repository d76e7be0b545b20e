/// Sections with fixed parameters whose values are not one struct of a library.
#pragma once

#include "dismantle/host/config.h"

namespace dismantle {

/// Copies the values of `config.sections["verify"]`, which must be complete, to `verify` and `named_overlap`.
void bind_verify_section(RunConfig& config);

}  // namespace dismantle
